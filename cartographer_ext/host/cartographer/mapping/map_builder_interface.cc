// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/map_builder_interface.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/pose_graph.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::MapBuilderOptions CreateMapBuilderOptions(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::MapBuilderOptions>(table);
  CHECK(options.use_trajectory_builder_2d() !=
        options.use_trajectory_builder_3d())
      << "set exactly one of use_trajectory_builder_2d and "
         "use_trajectory_builder_3d";
  CHECK_GT(options.num_background_threads(), 0) << "num_background_threads";
  *options.mutable_pose_graph_options() =
      common::ReadTable(table, "pose_graph", &CreatePoseGraphOptions);
  return options;
}

}  // namespace mapping
}  // namespace cartographer
