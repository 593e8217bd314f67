// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests whether a loop is possible, given the drift of local SLAM. (Paper G,
// improved graph optimisation 2024, section 3.4, checks the odometry after the
// optimisation; this is a cheap test before.)
//
// The path between the two nodes of a loop predicts their relative pose; the
// innovation is the difference measured by the loop:
//
//   E = prior^-1 (b <- a)  loop (a <- b),   chi^2 = E^T cov(E)^-1 E.
//
// Beyond a high quantile of chi^2 with 3 degrees of freedom the loop is vetoed.
// The default quantile of 0.9999 is generous, since real drift is not Gaussian.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_INNOVATION_VETO_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_INNOVATION_VETO_H_

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/uncertainty/cycle_consistency.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace loop_closure {

struct LoopCandidate;
struct LoopOptions;

// Bound of the test.
struct InnovationOptions {
  bool enabled = true;
  double chi_square_bound = 21.108;  // chi^2, 3 degrees of freedom, 0.9999
};

// Innovation of one loop.
struct InnovationResult {
  Pose2 innovation;        // E above; (b <- b), metres and radians
  double chi_square = 0.;  // infinity when E is not zero but certain to be
  double bound = 0.;       // on chi_square
  bool vetoed = false;     // beyond the bound
  // Standard deviations of `innovation`, in the worst direction in metres, and
  // in radians.
  double translation_sigma = 0.;
  double rotation_sigma = 0.;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of `innovation`
};

// Tests a loop (a <- b) against the prior (a <- b) from the path, which together
// close a cycle.
InnovationResult TestInnovation(double chi_square_bound,
                                const uncertainty::UncertainPose& prior,
                                const uncertainty::UncertainPose& loop);

// Tests a candidate within one trajectory against the path from its anchor to
// its node (without an anchor: from the node next to the submap's origin). Only
// the path is used: a loop that contradicts accepted ones may still prevail in
// the consensus. Empty where the path is not known.
absl::optional<InnovationResult> InnovationByPath(
    const LoopOptions& options, const uncertainty::PathUncertainty& paths,
    const LoopCandidate& candidate);

// The same into `innovation`, if enabled; rejects the candidate where it is
// vetoed.
void VetoByInnovation(const LoopOptions& options,
                      const uncertainty::PathUncertainty& paths,
                      LoopCandidate* candidate);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_CONSENSUS_INNOVATION_VETO_H_
