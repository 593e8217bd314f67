// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/optimization_problem_options.h"

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/common/internal/read_options.h"

namespace cartographer {
namespace mapping {
namespace optimization {

proto::OptimizationProblemOptions CreateOptimizationProblemOptions(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::OptimizationProblemOptions>(table);
  *options.mutable_ceres_solver_options() = common::ReadTable(
      table, "ceres_solver_options", &common::CreateCeresSolverOptionsProto);
  return options;
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
