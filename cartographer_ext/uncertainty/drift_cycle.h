// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Cycles of loops and pieces of path, by which the drift of local SLAM is estimated
// (drift_estimator.h).
//
// The effects A of a wrong turning and of a wrong scale are the rotation and the
// translation of the paths of a cycle, as measured: with their errors, which are
// those of the cycle. E would be explained by itself (errors in the regressors; 65
// cycles with the errors assumed made a turning of -6 %). As the paths close the cycle
// with its loops, their true rotation and translation are those measured less E.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_CYCLE_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_CYCLE_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace uncertainty {

// A cycle that would close without errors.
struct DriftCycle {
  Eigen::Vector3d error;  // metres, metres, radians
  CovarianceParts parts;  // of the error; loops are in `other`
  // Half width of the window in which its loops were searched, metres, > 0.
  double window = 5.;
};

// The heading of a cycle of one loop over a long path. Places that look alike are
// mostly parallel, so the heading of a loop tells the drift of the heading even
// where the place is wrong.
struct HeadingCycle {
  double error = 0.;     // radians
  double rotation = 0.;  // prior variances from rotation, square radians
  double turning = 0.;
  double other = 0.;
  // Effects of the errors of CommonDrift.
  Eigen::Vector3d common = Eigen::Vector3d::Zero();
  double length = 0.;  // of the path, metres
};

// A piece of the path of local SLAM, not corrected.
struct DriftStretch {
  Pose2 pose;
  CovarianceParts parts;
};

// The cycle of two loops (cycle_consistency.h): `loop_u` is (a_u <- b_u),
// `path_b` (b_u <- b_v), `loop_v` (a_v <- b_v), `path_a` (a_v <- a_u).
DriftCycle CycleOfLoops(const UncertainPose& loop_u, const DriftStretch& path_b,
                        const UncertainPose& loop_v,
                        const DriftStretch& path_a);
// The cycle of one loop (a <- b) with the path (b <- a).
DriftCycle CycleOfLoop(const UncertainPose& loop, const DriftStretch& path);

// The same of a long path.
HeadingCycle HeadingOfLoop(const UncertainPose& loop, const DriftStretch& path);

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_CYCLE_H_
