// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The residual of sparse pose adjustment in the plane (Konolige et al.,
// "Efficient sparse pose adjustment for 2D mapping", IROS 2010, equation 1):
// how far the relative pose of two bodies is from the measured one,
//
//   r = ( w_t (z_xy - R(theta_i)^T (t_j - t_i)),
//         w_r wrap(z_theta - (theta_j - theta_i)) ).
//
// Roll, pitch and height of the measurement do not count. A worked example:
// bodies at (0, 0, 0) and (1, 0, 0), measured (1.1, 0, 0.2), weights 10 and 5:
// r = (1, 0, 1).
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_SPA_COST_FUNCTION_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_SPA_COST_FUNCTION_2D_H_

#include "cartographer/mapping/pose_graph_interface.h"
#include "ceres/ceres.h"

namespace cartographer {
namespace mapping {
namespace optimization {

// Both have parameter blocks (x, y, theta) of i and of j, and give the same
// values and Jacobians.
ceres::CostFunction* CreateAutoDiffSpaCostFunction(
    const PoseGraphInterface::Constraint::Pose& pose);
ceres::CostFunction* CreateAnalyticalSpaCostFunction(
    const PoseGraphInterface::Constraint::Pose& pose);

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_COST_FUNCTIONS_SPA_COST_FUNCTION_2D_H_
