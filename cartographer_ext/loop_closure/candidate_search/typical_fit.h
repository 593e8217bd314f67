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
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/loop_closure/verification/score_window.h"

namespace cartographer_ext {
namespace loop_closure {

// Reference and limits of the scale.
struct TypicalFitOptions {
  double reference = 0.65;   // in (0, 1]; 0: the scale is always 1
  double least_scale = 0.7;  // in (0, 1]
  // The same where scans see less than `narrow_sector` (radians): those fit many
  // places, and more of them the lower the minimum.
  double least_scale_of_narrow = 0.85;
  double narrow_sector = 0.5 * kPi;
  size_t window = 200;   // most recent scores used
  size_t min_fits = 20;  // with fewer the scale is 1
};

// The smallest sector around the origin that holds all points, in steps of five
// degrees; radians in [0, 2 pi]. 0 without points.
double SectorSeen(const std::vector<Eigen::Vector2f>& points);

// Typical scores by trajectory, see above.
class TypicalFit {
 public:
  explicit TypicalFit(const TypicalFitOptions& options) : options_(options) {}

  // If false, scores need not be measured.
  bool is_on() const { return options_.reference > 0.; }
  // `fit`: mean probability under the points of a scan, in [0, 1]; `sector`: where
  // they lie around the robot (SectorSeen).
  void Add(int trajectory_id, double fit, double sector);
  // Factor on minimum scores of searches, in [least_scale, 1] or, where the mean of
  // the sectors is narrow, in [least_scale_of_narrow, 1].
  double Scale(int trajectory_id) const;
  void DeleteTrajectory(int trajectory_id) { fits_.erase(trajectory_id); }

 private:
  struct Fits {
    explicit Fits(size_t window) : scores(window), sectors(window) {}
    ScoreWindow scores;
    ScoreWindow sectors;
  };

  const TypicalFitOptions options_;
  std::map<int, Fits> fits_;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CANDIDATE_SEARCH_TYPICAL_FIT_H_
