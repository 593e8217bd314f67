// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/ceres_solver_options.h"

#include "cartographer/common/internal/read_options.h"
#include "glog/logging.h"

namespace cartographer {
namespace common {

proto::CeresSolverOptions CreateCeresSolverOptionsProto(
    common::LuaParameterDictionary* const table) {
  const auto proto = ReadOptions<proto::CeresSolverOptions>(table);
  CHECK_GT(proto.max_num_iterations(), 0);
  CHECK_GT(proto.num_threads(), 0);
  return proto;
}

ceres::Solver::Options CreateCeresSolverOptions(
    const proto::CeresSolverOptions& proto) {
  ceres::Solver::Options options;
  options.use_nonmonotonic_steps = proto.use_nonmonotonic_steps();
  options.max_num_iterations = proto.max_num_iterations();
  options.num_threads = proto.num_threads();
  return options;
}

}  // namespace common
}  // namespace cartographer
