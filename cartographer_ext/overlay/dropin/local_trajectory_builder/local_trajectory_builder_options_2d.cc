// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"

#include "cartographer_ext/front_end_options.pb.h"
#include "cartographer_ext/options/dropin/lua_options.h"
#include "cartographer_ext/options/extension_field.h"
#include "cartographer_ext/options/lua_path.h"
#include "cartographer_ext/overlay/signature.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_LOCAL_TRAJECTORY_BUILDER_OPTIONS_2D_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(StockCreateLocalTrajectoryBuilderOptions2D,
                                  proto::LocalTrajectoryBuilderOptions2D (*)(
                                      common::LuaParameterDictionary*));

proto::LocalTrajectoryBuilderOptions2D CreateLocalTrajectoryBuilderOptions2D(
    common::LuaParameterDictionary* const parameter_dictionary) {
  namespace ext = ::cartographer_ext::options;
  const std::string path = "TRAJECTORY_BUILDER_2D";
  const ext::ScopedLuaPath scope(path);
  proto::LocalTrajectoryBuilderOptions2D options =
      StockCreateLocalTrajectoryBuilderOptions2D(parameter_dictionary);
  ::cartographer_ext::proto::FrontEndOptions extension;
  if (ext::ReadExtension(path, parameter_dictionary, &extension)) {
    ext::SetExtension(extension, &options);
  }
  return options;
}

}  // namespace mapping
}  // namespace cartographer
