// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path: the factories found
// there get the prefix Stock, and those of the original names also support
// constraints with a full information matrix.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION) || \
    defined(CreateAutoDiffSpaCostFunction)
// Not selected, or this is the stock source with its functions renamed.
#include_next "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_SPA_COST_FUNCTION_2D_H_
#define CARTOGRAPHER_EXT_OVERLAY_SPA_COST_FUNCTION_2D_H_

#define CreateAutoDiffSpaCostFunction StockCreateAutoDiffSpaCostFunction
#define CreateAnalyticalSpaCostFunction StockCreateAnalyticalSpaCostFunction
#include_next "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"
#undef CreateAutoDiffSpaCostFunction
#undef CreateAnalyticalSpaCostFunction

namespace cartographer {
namespace mapping {
namespace optimization {

// The stock residual, or, for a loop that has a full information matrix
// (cartographer_ext/common/loop_information.h), the one weighted by the matrix.
ceres::CostFunction* CreateAutoDiffSpaCostFunction(
    const PoseGraphInterface::Constraint::Pose& pose);
ceres::CostFunction* CreateAnalyticalSpaCostFunction(
    const PoseGraphInterface::Constraint::Pose& pose);

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_SPA_COST_FUNCTION_2D_H_
#endif
