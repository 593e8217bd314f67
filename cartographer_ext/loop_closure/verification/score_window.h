// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The last k scores of a kind, with their mean and variance, for the dynamic
// threshold (paper C, optimised Cartographer 2025, eq. 2 and 3) and the score
// fusion (eq. 6). Scores are added in the order of the candidates. Not
// thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_WINDOW_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_WINDOW_H_

#include <cstddef>
#include <deque>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {

// The last k scores, see above.
class ScoreWindow {
 public:
  explicit ScoreWindow(size_t capacity) : capacity_(capacity) {
    CHECK_GT(capacity, 0u);
  }

  void Add(double score) {
    scores_.push_back(score);
    if (scores_.size() > capacity_) scores_.pop_front();
  }

  size_t size() const { return scores_.size(); }
  // Whether k scores have been seen; before that the statistics are not used.
  bool full() const { return scores_.size() == capacity_; }

  // C eq. 3. Zero when empty.
  double Mean() const {
    if (scores_.empty()) return 0.;
    double sum = 0.;
    for (const double score : scores_) sum += score;
    return sum / static_cast<double>(scores_.size());
  }

  // C eq. 2: the population variance, divided by k. Zero when empty.
  double Variance() const {
    if (scores_.empty()) return 0.;
    const double mean = Mean();
    double sum = 0.;
    for (const double score : scores_) sum += (score - mean) * (score - mean);
    return sum / static_cast<double>(scores_.size());
  }

 private:
  const size_t capacity_;
  std::deque<double> scores_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_VERIFICATION_SCORE_WINDOW_H_
