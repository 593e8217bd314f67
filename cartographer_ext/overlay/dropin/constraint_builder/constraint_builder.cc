// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/constraints/constraint_builder.h"

#include "cartographer_ext/loop_closure_options.pb.h"
#include "cartographer_ext/options/dropin/lua_options.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/lua_path.h"
#include "cartographer_ext/overlay/signature.h"
#include "cartographer_ext/swaps.h"
#include "glog/logging.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace constraints {

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(
    StockCreateConstraintBuilderOptions,
    proto::ConstraintBuilderOptions (*)(common::LuaParameterDictionary*));

proto::ConstraintBuilderOptions CreateConstraintBuilderOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  namespace ext = ::cartographer_ext::options;
  const std::string path = ext::LuaPathOf("constraint_builder", "POSE_GRAPH");
  const ext::ScopedLuaPath scope(path);
  proto::ConstraintBuilderOptions options =
      StockCreateConstraintBuilderOptions(parameter_dictionary);
  ::cartographer_ext::proto::LoopClosureOptions extension;
  if (ext::ReadExtension(path, parameter_dictionary, &extension)) {
#if !defined(CARTOGRAPHER_EXT_SWAP_FULL_INFORMATION) || \
    !defined(CARTOGRAPHER_EXT_SWAP_OPTIMIZATION_PROBLEM)
    CHECK(!extension.information().full_matrix())
        << path << "." << ext::kExtensionKey
        << ".information.full_matrix: true needs the swaps full_information "
           "and optimization_problem, which this build does not have";
#endif
    ext::SetExtension(extension, &options);
  }
  return options;
}

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer
