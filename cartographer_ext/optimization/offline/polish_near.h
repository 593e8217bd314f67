// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Among all poses with about the lowest truncated cost, those near to given
// ones. Where information matrices are far too careful, a wrong loop inside the
// gate bends the map by decimetres for a gain of less than one in a million:
// the cost does not tell such maps apart, the loops that agree do
// (AdaptiveGate). This keeps both, the lowest cost and the shape that the
// agreeing loops give.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_POLISH_NEAR_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_POLISH_NEAR_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Ties each pose to its place in `target` and solves from `poses` by the gate
// (PolishTruncated), with ties as strong as a truncated cost of at most `limit`
// permits. Poses that meet the limit without them should be given; where even
// the weakest ties exceed it they stay as they are. `weights`, if not null,
// receives one value per edge. `target` and `poses` agree in the first pose.
SolverSummary PolishNear(const std::vector<WhitenedEdge>& edges,
                         const std::vector<Pose2>& target, double limit,
                         std::vector<Pose2>* poses,
                         std::vector<double>* weights);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_POLISH_NEAR_H_
