// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"

#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"
#include "cartographer/mapping/pose_extrapolator_interface.h"
#include "cartographer/sensor/internal/voxel_filter.h"

namespace cartographer {
namespace mapping {

proto::LocalTrajectoryBuilderOptions2D CreateLocalTrajectoryBuilderOptions2D(
    common::LuaParameterDictionary* const parameter_dictionary) {
  common::LuaParameterDictionary& lua = *parameter_dictionary;
  proto::LocalTrajectoryBuilderOptions2D options;
  // What of a scan is used.
  options.set_use_imu_data(lua.GetBool("use_imu_data"));
  options.set_min_range(lua.GetDouble("min_range"));
  options.set_max_range(lua.GetDouble("max_range"));
  options.set_min_z(lua.GetDouble("min_z"));
  options.set_max_z(lua.GetDouble("max_z"));
  options.set_missing_data_ray_length(lua.GetDouble("missing_data_ray_length"));
  options.set_num_accumulated_range_data(
      lua.GetInt("num_accumulated_range_data"));
  options.set_voxel_filter_size(lua.GetDouble("voxel_filter_size"));
  *options.mutable_adaptive_voxel_filter_options() =
      sensor::CreateAdaptiveVoxelFilterOptions(
          lua.GetDictionary("adaptive_voxel_filter").get());
  *options.mutable_loop_closure_adaptive_voxel_filter_options() =
      sensor::CreateAdaptiveVoxelFilterOptions(
          lua.GetDictionary("loop_closure_adaptive_voxel_filter").get());
  // How it is matched.
  options.set_imu_gravity_time_constant(
      lua.GetDouble("imu_gravity_time_constant"));
  *options.mutable_pose_extrapolator_options() = CreatePoseExtrapolatorOptions(
      lua.GetDictionary("pose_extrapolator").get());
  options.set_use_online_correlative_scan_matching(
      lua.GetBool("use_online_correlative_scan_matching"));
  *options.mutable_real_time_correlative_scan_matcher_options() =
      scan_matching::CreateRealTimeCorrelativeScanMatcherOptions(
          lua.GetDictionary("real_time_correlative_scan_matcher").get());
  *options.mutable_ceres_scan_matcher_options() =
      scan_matching::CreateCeresScanMatcherOptions2D(
          lua.GetDictionary("ceres_scan_matcher").get());
  // What is kept of it.
  *options.mutable_motion_filter_options() =
      CreateMotionFilterOptions(lua.GetDictionary("motion_filter").get());
  *options.mutable_submaps_options() =
      CreateSubmapsOptions2D(lua.GetDictionary("submaps").get());
  return options;
}

}  // namespace mapping
}  // namespace cartographer
