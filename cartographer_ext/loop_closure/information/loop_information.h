// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Uncertainty of a loop: the covariance of its match, which consensus uses, and
// the weights and the full information of its constraint
// (constraint_information.h).
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_LOOP_INFORMATION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_LOOP_INFORMATION_H_

#include "Eigen/Core"
#include "cartographer_ext/loop_closure/information/constraint_information.h"
#include "cartographer_ext/loop_closure/loop_candidate.h"
#include "cartographer_ext/loop_closure/loop_options.h"

namespace cartographer_ext {
namespace loop_closure {

// Covariance of the match of a candidate, in the frame of the node: the
// constant part from the options plus the uncertainty along directions that the
// scan does not observe, such as a corridor.
Eigen::Matrix3d MatchCovariance(const LoopOptions& options,
                                const LoopCandidate& candidate);

// Weights from the final score (C eq. 8 to 11) and, if the options request it
// and the information of the match is known, the full matrix.
void WeighConstraint(const LoopOptions& options,
                     const ConstraintWeights& stock_weights,
                     LoopCandidate* candidate);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_INFORMATION_LOOP_INFORMATION_H_
