// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What R-iSAM does at the end of the data, where odometry was too weak to
// accept a loop by itself: a map that costs less than the replay's by more than
// the gate's own doubt replaces it. It is grown by groups of loops
// (loop_growth.h) or by certain loops and groups in turn (certain_growth.h),
// solved by kernels as wide as the gate, which see what has ended up just behind
// it, and then lost groups are forced in (decision_moves.h).
//
// On a graph that is too large for growth by groups all that only happens where
// the replay has lost nearly all loops that agree with others, and the map is
// grown by the loops that are certain (certain_growth.h).
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_READMISSION_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_READMISSION_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Replaces poses and decisions of `replay` and returns true if there is such a
// map. Does nothing if no loop can have been lost, or too few of a large graph.
// `edges` are those of the graph and of `solver`, as for ForceGroups.
bool ReadmitGroups(const PoseGraph& graph, std::vector<WhitenedEdge>* edges,
                   RobustSolver* solver, ReplayResult* replay);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_READMISSION_H_
