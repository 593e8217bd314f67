// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/map_builder_interface.h"

#include "cartographer/mapping/pose_graph.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::MapBuilderOptions CreateMapBuilderOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  const bool use_2d =
      parameter_dictionary->GetBool("use_trajectory_builder_2d");
  const bool use_3d =
      parameter_dictionary->GetBool("use_trajectory_builder_3d");
  CHECK_NE(use_2d, use_3d) << "set exactly one of use_trajectory_builder_2d "
                              "and use_trajectory_builder_3d";
  proto::MapBuilderOptions options;
  options.set_use_trajectory_builder_2d(use_2d);
  options.set_use_trajectory_builder_3d(use_3d);
  options.set_num_background_threads(
      parameter_dictionary->GetNonNegativeInt("num_background_threads"));
  options.set_collate_by_trajectory(
      parameter_dictionary->GetBool("collate_by_trajectory"));
  *options.mutable_pose_graph_options() = CreatePoseGraphOptions(
      parameter_dictionary->GetDictionary("pose_graph").get());
  return options;
}

}  // namespace mapping
}  // namespace cartographer
