// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether two loop constraints can both be true (paper G, improved graph
// optimisation 2024, section 3.4, eq. 20).
//
// Loop u estimates the pose of node b_u in the frame of anchor a_u, loop v the
// same for b_v and a_v. The cycle from a_u over loop u to b_u, along the
// trajectory to b_v, back over loop v to a_v and along the trajectory to a_u
// closes when both are true:
//
//   E = T_u (b_u <- b_v) T_v^-1 (a_v <- a_u) = identity
//
// Eq. 20 as printed has the factors in an order that does not close; this is
// the standard cycle of four edges. E is compared
//
//   kChiSquare   with its covariance, propagated to first order through all
//                four edges, against a quantile of chi^2 with 3 degrees of
//                freedom,
//   kFixedBound  with fixed bounds in metres and radians (eq. 20 as printed).
//
// A fixed bound is too strict for long paths and too lax for short ones.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_CYCLE_CONSISTENCY_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_CYCLE_CONSISTENCY_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace uncertainty {

// How the error of a cycle is tested, see above.
enum class CycleTest { kChiSquare, kFixedBound };

// Bounds of the test.
struct CycleConsistencyOptions {
  CycleTest test = CycleTest::kChiSquare;
  double chi_square_bound = 11.345;  // chi^2, 3 degrees of freedom, 0.99
  double translation_bound = 0.5;    // metres, kFixedBound
  double rotation_bound = 0.1;       // radians, kFixedBound
};

// Result of the test of one cycle.
struct CycleResult {
  Pose2 error;  // E above, identity for a perfect cycle
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of E, frame a_u
  double chi_square = 0.;  // squared Mahalanobis norm of E; infinity when the
                           // covariance is singular and E is not zero
  bool compatible = false;
};

// `loop_u` is (a_u <- b_u), `path_b` (b_u <- b_v), `loop_v` (a_v <- b_v),
// `path_a` (a_v <- a_u).
CycleResult TestCycle(const CycleConsistencyOptions& options,
                      const UncertainPose& loop_u, const UncertainPose& path_b,
                      const UncertainPose& loop_v, const UncertainPose& path_a);

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_CYCLE_CONSISTENCY_H_
