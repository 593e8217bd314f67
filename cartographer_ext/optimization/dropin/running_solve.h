// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Optimises the whole graph while a run goes on, to the precision that the run
// needs.
//
// The poses of an optimisation during the run tell where to search for loops,
// with windows of decimetres, and are where the next optimisation starts. So
// Gauss-Newton steps may end when the last one moved no pose by more than a
// small part of a cell; Ceres, as Cartographer calls it, goes on until the cost
// no longer decreases. The problem is Cartographer's: the same residuals,
// weights and Huber loss, the very first submap fixed. It is solved by
// RobustSolver.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_RUNNING_SOLVE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_RUNNING_SOLVE_H_

#include <map>
#include <vector>

#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/proto/pose_graph/optimization_problem_options.pb.h"
#include "cartographer_ext/common/pose_graph_context.h"

namespace cartographer_ext {
namespace optimization {

// Moves the poses of `problem`; `tolerance` (metres and radians) bounds the last
// step. Returns false and changes nothing where Cartographer has to solve it:
// with frozen trajectories, with odometry that counts beside local SLAM, or if
// the graph does not determine all poses. The caller sees to it that there are no
// landmarks and no fixed frames. `context` may be null.
bool SolveRunning(
    const cartographer::mapping::optimization::proto::
        OptimizationProblemOptions& options,
    const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
        constraints,
    const std::map<int,
                   cartographer::mapping::PoseGraphInterface::TrajectoryState>&
        trajectories_state,
    double tolerance, PoseGraphContext* context,
    cartographer::mapping::optimization::StockOptimizationProblem2D* problem);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_RUNNING_SOLVE_H_
