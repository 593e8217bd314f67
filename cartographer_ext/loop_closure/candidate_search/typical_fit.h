// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How well scans fit the submaps of their own run where nobody doubts their
// place: right behind the end of a submap, at the pose that local SLAM gives.
//
// `min_score` was chosen in buildings, where such scans reach 0.7. Between
// bushes they reach 0.5, and a floor of 0.55 shuts out every true loop. The
// floor follows the mean of the last fits below a reference:
//   scale = min(1, max(least_scale, mean / reference)),
// 1 until there are enough of them.
//
// Not thread-safe; depends on the sequence of calls only.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_

#include <cstddef>
#include <map>

#include "cartographer_ext/loop_closure/verification/score_window.h"

namespace cartographer_ext {
namespace loop_closure {

struct TypicalFitOptions {
  double reference = 0.65;    // in (0, 1]; 0: the scale is always 1
  double least_scale = 0.85;  // in (0, 1]
  size_t window = 200;        // fits of a run that count
  size_t min_fits = 20;       // before that nothing is said
};

class TypicalFit {
 public:
  explicit TypicalFit(const TypicalFitOptions& options) : options_(options) {}

  // Otherwise there is no need to measure fits.
  bool is_on() const { return options_.reference > 0.; }
  // `fit`: mean probability under the points of a scan, in [0, 1].
  void Add(int trajectory_id, double fit);
  // By which floors of scores are multiplied, in [least_scale, 1].
  double Scale(int trajectory_id) const;
  void DeleteTrajectory(int trajectory_id) { fits_.erase(trajectory_id); }

 private:
  const TypicalFitOptions options_;
  std::map<int, ScoreWindow> fits_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_
