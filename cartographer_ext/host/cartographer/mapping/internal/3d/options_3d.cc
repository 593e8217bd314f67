// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/3d/options_3d.h"

#include <string>

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"
#include "cartographer/mapping/pose_extrapolator_interface.h"
#include "cartographer/sensor/internal/voxel_filter.h"

namespace cartographer {
namespace mapping {

using common::LuaParameterDictionary;

namespace scan_matching {

proto::FastCorrelativeScanMatcherOptions3D
CreateFastCorrelativeScanMatcherOptions3D(
    LuaParameterDictionary* const parameter_dictionary) {
  LuaParameterDictionary& lua = *parameter_dictionary;
  proto::FastCorrelativeScanMatcherOptions3D options;
  options.set_linear_xy_search_window(lua.GetDouble("linear_xy_search_window"));
  options.set_linear_z_search_window(lua.GetDouble("linear_z_search_window"));
  options.set_angular_search_window(lua.GetDouble("angular_search_window"));
  options.set_branch_and_bound_depth(lua.GetInt("branch_and_bound_depth"));
  options.set_full_resolution_depth(lua.GetInt("full_resolution_depth"));
  options.set_min_rotational_score(lua.GetDouble("min_rotational_score"));
  options.set_min_low_resolution_score(
      lua.GetDouble("min_low_resolution_score"));
  return options;
}

proto::CeresScanMatcherOptions3D CreateCeresScanMatcherOptions3D(
    LuaParameterDictionary* const parameter_dictionary) {
  LuaParameterDictionary& lua = *parameter_dictionary;
  proto::CeresScanMatcherOptions3D options;
  // One weight, and optionally one table, per resolution: ..._0, ..._1, ...
  std::string key;
  for (int i = 0;
       lua.HasKey(key = "occupied_space_weight_" + std::to_string(i)); ++i) {
    options.add_occupied_space_weight(lua.GetDouble(key));
  }
  for (int i = 0;
       lua.HasKey(key = "intensity_cost_function_options_" + std::to_string(i));
       ++i) {
    const auto table = lua.GetDictionary(key);
    auto* const intensity = options.add_intensity_cost_function_options();
    intensity->set_weight(table->GetDouble("weight"));
    intensity->set_huber_scale(table->GetDouble("huber_scale"));
    intensity->set_intensity_threshold(table->GetDouble("intensity_threshold"));
  }
  options.set_translation_weight(lua.GetDouble("translation_weight"));
  options.set_rotation_weight(lua.GetDouble("rotation_weight"));
  options.set_only_optimize_yaw(lua.GetBool("only_optimize_yaw"));
  *options.mutable_ceres_solver_options() =
      common::CreateCeresSolverOptionsProto(
          lua.GetDictionary("ceres_solver_options").get());
  return options;
}

}  // namespace scan_matching

namespace {

proto::SubmapsOptions3D ReadSubmapsOptions(LuaParameterDictionary* const lua) {
  proto::SubmapsOptions3D options;
  options.set_high_resolution(lua->GetDouble("high_resolution"));
  options.set_high_resolution_max_range(
      lua->GetDouble("high_resolution_max_range"));
  options.set_low_resolution(lua->GetDouble("low_resolution"));
  options.set_num_range_data(lua->GetNonNegativeInt("num_range_data"));
  const auto table = lua->GetDictionary("range_data_inserter");
  auto* const inserter = options.mutable_range_data_inserter_options();
  inserter->set_hit_probability(table->GetDouble("hit_probability"));
  inserter->set_miss_probability(table->GetDouble("miss_probability"));
  inserter->set_num_free_space_voxels(table->GetInt("num_free_space_voxels"));
  inserter->set_intensity_threshold(table->GetDouble("intensity_threshold"));
  return options;
}

}  // namespace

proto::LocalTrajectoryBuilderOptions3D CreateLocalTrajectoryBuilderOptions3D(
    LuaParameterDictionary* const parameter_dictionary) {
  LuaParameterDictionary& lua = *parameter_dictionary;
  proto::LocalTrajectoryBuilderOptions3D options;
  options.set_min_range(lua.GetDouble("min_range"));
  options.set_max_range(lua.GetDouble("max_range"));
  options.set_num_accumulated_range_data(
      lua.GetInt("num_accumulated_range_data"));
  options.set_voxel_filter_size(lua.GetDouble("voxel_filter_size"));
  options.set_imu_gravity_time_constant(
      lua.GetDouble("imu_gravity_time_constant"));
  options.set_rotational_histogram_size(
      lua.GetInt("rotational_histogram_size"));
  options.set_use_intensities(lua.GetBool("use_intensities"));
  options.set_use_online_correlative_scan_matching(
      lua.GetBool("use_online_correlative_scan_matching"));
  *options.mutable_high_resolution_adaptive_voxel_filter_options() =
      sensor::CreateAdaptiveVoxelFilterOptions(
          lua.GetDictionary("high_resolution_adaptive_voxel_filter").get());
  *options.mutable_low_resolution_adaptive_voxel_filter_options() =
      sensor::CreateAdaptiveVoxelFilterOptions(
          lua.GetDictionary("low_resolution_adaptive_voxel_filter").get());
  *options.mutable_real_time_correlative_scan_matcher_options() =
      scan_matching::CreateRealTimeCorrelativeScanMatcherOptions(
          lua.GetDictionary("real_time_correlative_scan_matcher").get());
  *options.mutable_ceres_scan_matcher_options() =
      scan_matching::CreateCeresScanMatcherOptions3D(
          lua.GetDictionary("ceres_scan_matcher").get());
  *options.mutable_motion_filter_options() =
      CreateMotionFilterOptions(lua.GetDictionary("motion_filter").get());
  *options.mutable_pose_extrapolator_options() = CreatePoseExtrapolatorOptions(
      lua.GetDictionary("pose_extrapolator").get());
  *options.mutable_submaps_options() =
      ReadSubmapsOptions(lua.GetDictionary("submaps").get());
  return options;
}

}  // namespace mapping
}  // namespace cartographer
