// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/optimization_problem_options.h"

#include "cartographer_ext/options/dropin/lua_options.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/lua_path.h"
#include "cartographer_ext/overlay/signature.h"
#include "cartographer_ext/robust_optimization_options.pb.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_OPTIMIZATION_PROBLEM_OPTIONS_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace optimization {

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    StockCreateOptimizationProblemOptions,
    proto::OptimizationProblemOptions (*)(common::LuaParameterDictionary*));

proto::OptimizationProblemOptions CreateOptimizationProblemOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  namespace ext = ::cartographer_ext::options;
  proto::OptimizationProblemOptions options =
      StockCreateOptimizationProblemOptions(parameter_dictionary);
  ::cartographer_ext::proto::RobustOptimizationOptions extension;
  if (ext::ReadExtension(ext::LuaPathOf("optimization_problem", "POSE_GRAPH"),
                         parameter_dictionary, &extension)) {
    ext::SetExtension(extension, &options);
  }
  return options;
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
