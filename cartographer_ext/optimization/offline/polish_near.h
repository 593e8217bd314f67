// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Among all poses with about the lowest truncated cost, those near to given
// ones. If information matrices are far too conservative, a wrong loop inside
// the gate bends the map by decimetres for a cost decrease of less than one in
// a million: the cost does not distinguish such maps, but the loops that agree
// do (AdaptiveGate). This combines both, the lowest cost and the shape given by
// the agreeing loops.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_POLISH_NEAR_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_POLISH_NEAR_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Adds a prior at its pose in `target` to each pose and solves from `poses` by
// the gate (PolishTruncated), with priors as strong as a truncated cost of at
// most `limit` permits. `poses` should meet the limit without priors; if even
// the weakest priors exceed it, they are unchanged. `weights`, if not null,
// receives one value per edge. `target` and `poses` agree in the first pose.
SolverSummary PolishNear(const std::vector<WhitenedEdge>& edges,
                         const std::vector<Pose2>& target, double limit,
                         std::vector<Pose2>* poses,
                         std::vector<double>* weights);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_POLISH_NEAR_H_
