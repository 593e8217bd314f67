// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Calls the stock optimisation; loops that have a full information matrix in
// the context of the pose graph are weighted by it (common/loop_information.h),
// and the problem may be relaxed (optimization/graph/relaxation.h), if the swap
// `full_information` is built.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_STOCK_SOLVE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_STOCK_SOLVE_H_

#include <map>
#include <string>
#include <vector>

#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/optimization/graph/relaxation.h"

namespace cartographer_ext {
namespace optimization {

// `context` and `relaxation` may be null.
void StockSolve(
    const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
        constraints,
    const std::map<int,
                   cartographer::mapping::PoseGraphInterface::TrajectoryState>&
        trajectories_state,
    const std::map<std::string,
                   cartographer::mapping::PoseGraphInterface::LandmarkNode>&
        landmark_nodes,
    PoseGraphContext* context, const Relaxation* relaxation,
    cartographer::mapping::optimization::StockOptimizationProblem2D* problem);

// The constraints that are not withdrawn (common/withdrawn_loops.h). Returns
// `constraints` itself if all are in force, otherwise a reference to `*kept`.
const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
WithoutWithdrawnLoops(
    const std::vector<cartographer::mapping::PoseGraphInterface::Constraint>&
        constraints,
    PoseGraphContext* context,
    std::vector<cartographer::mapping::PoseGraphInterface::Constraint>* kept);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_DROPIN_STOCK_SOLVE_H_
