// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path: the stock factory
// becomes StockCreateOptimizationProblemOptions, and the one of the original
// name also reads our block.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM) || \
    defined(CreateOptimizationProblemOptions)
// Not selected, or this is the stock source with its function renamed.
#include_next "cartographer/mapping/internal/optimization/optimization_problem_options.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_OPTIONS_H_
#define CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_OPTIONS_H_

#define CreateOptimizationProblemOptions StockCreateOptimizationProblemOptions
#include_next "cartographer/mapping/internal/optimization/optimization_problem_options.h"
#undef CreateOptimizationProblemOptions

namespace cartographer {
namespace mapping {
namespace optimization {

proto::OptimizationProblemOptions CreateOptimizationProblemOptions(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_OPTIONS_H_
#endif
