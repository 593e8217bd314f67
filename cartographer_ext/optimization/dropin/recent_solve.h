// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Optimises the newest part of a pose graph while everything older is held, at
// a cost that does not depend on the length of the run.
//
// Unknowns are the newest nodes of one trajectory and the submaps that they
// were inserted into. The terms are those of Cartographer's problem that touch
// them: constraints with submaps, loops under a Huber loss, and the motion by
// local SLAM between consecutive nodes. Odometry, landmarks and fixed frames
// are left to the optimisations of the whole graph.
//
// Holding the rest is right as long as new loops agree with it, as in a
// building that has been mapped. A loop that closes a long detour moves the new
// part by what should have been distributed over all of the detour, or is not
// fulfilled; then the whole graph has to be optimised.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_RECENT_SOLVE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_RECENT_SOLVE_H_

#include <functional>
#include <vector>

#include "cartographer/mapping/id.h"
#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/optimization_problem_options.pb.h"

namespace cartographer_ext {
namespace optimization {

// The poses of a graph, (global <- node) and (global <- submap).
struct GraphPoses {
  cartographer::mapping::MapById<
      cartographer::mapping::NodeId,
      cartographer::mapping::optimization::NodeSpec2D>* nodes;
  cartographer::mapping::MapById<
      cartographer::mapping::SubmapId,
      cartographer::mapping::optimization::SubmapSpec2D>* submaps;
};

// Result of one optimisation.
struct RecentResult {
  bool usable = false;  // otherwise the poses have not changed
  int num_nodes = 0;    // unknown
  // How far they have moved, at most, metres and radians.
  double largest_move = 0.;
  double largest_turn = 0.;
  int num_loops = 0;  // between unknowns, or an unknown and a held pose
  // Of these, how many the result contradicts by more than 0.25 m or 3 degrees.
  int num_contradicted = 0;
};

// `first_node`: the oldest unknown; it and all newer nodes of its trajectory
// are. `constraints` must be in the order in which the pose graph has added
// them; those for which `is_in_force` is false do not count. The very first
// submap is always held.
RecentResult SolveRecent(
    const cartographer::mapping::optimization::proto::
        OptimizationProblemOptions& options,
    const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
        constraints,
    const std::function<
        bool(const cartographer::mapping::PoseGraphInterface::Constraint&)>&
        is_in_force,
    const cartographer::mapping::NodeId& first_node, const GraphPoses& poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_RECENT_SOLVE_H_
