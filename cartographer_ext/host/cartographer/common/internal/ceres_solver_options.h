// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_INTERNAL_CERES_SOLVER_OPTIONS_H_
#define CARTOGRAPHER_COMMON_INTERNAL_CERES_SOLVER_OPTIONS_H_

#include "cartographer/common/lua_parameter_dictionary.h"
#include "cartographer/common/proto/ceres_solver_options.pb.h"
#include "ceres/ceres.h"

namespace cartographer {
namespace common {

// Reads use_nonmonotonic_steps, max_num_iterations (> 0) and num_threads (> 0).
proto::CeresSolverOptions CreateCeresSolverOptionsProto(
    common::LuaParameterDictionary* parameter_dictionary);

ceres::Solver::Options CreateCeresSolverOptions(
    const proto::CeresSolverOptions& proto);

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_INTERNAL_CERES_SOLVER_OPTIONS_H_
