// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Typical scores of scans in submaps of their own run at certain poses: right
// after the end of a submap, at the pose of local SLAM.
//
// `min_score` was chosen in buildings, where such scans score 0.7. Among bushes,
// and in submaps of one scan per metre, they score 0.5, and a minimum of 0.55
// rejects every true loop. So the minimum
// score is scaled by the mean of the last scores, if that is below a reference:
//   scale = min(1, max(least_scale, mean / reference)),
// with 1 until there are enough of them.
//
// Not thread-safe; depends on the sequence of calls only.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_

#include <cstddef>
#include <map>

#include "cartographer_ext/loop_closure/verification/score_window.h"

namespace cartographer_ext {
namespace loop_closure {

// Reference and limits of the scale.
struct TypicalFitOptions {
  double reference = 0.65;   // in (0, 1]; 0: the scale is always 1
  double least_scale = 0.7;  // in (0, 1]
  size_t window = 200;       // most recent scores used
  size_t min_fits = 20;      // with fewer the scale is 1
};

// Typical scores by trajectory, see above.
class TypicalFit {
 public:
  explicit TypicalFit(const TypicalFitOptions& options) : options_(options) {}

  // If false, scores need not be measured.
  bool is_on() const { return options_.reference > 0.; }
  // `fit`: mean probability under the points of a scan, in [0, 1].
  void Add(int trajectory_id, double fit);
  // Factor on minimum scores of searches, in [least_scale, 1].
  double Scale(int trajectory_id) const;
  void DeleteTrajectory(int trajectory_id) { fits_.erase(trajectory_id); }

 private:
  const TypicalFitOptions options_;
  std::map<int, ScoreWindow> fits_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_
