// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/3d/options_3d.h"

#include <string>
#include <vector>

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"
#include "cartographer/mapping/pose_extrapolator_interface.h"
#include "cartographer/sensor/internal/voxel_filter.h"

namespace cartographer {
namespace mapping {

using common::LuaParameterDictionary;

namespace scan_matching {
namespace {

// The keys prefix0, prefix1, ... as far as the table has them.
std::vector<std::string> Numbered(const std::string& prefix,
                                  const LuaParameterDictionary& table) {
  std::vector<std::string> keys;
  std::string next = prefix + "0";
  while (table.HasKey(next)) {
    keys.push_back(next);
    next = prefix + std::to_string(keys.size());
  }
  return keys;
}

}  // namespace

proto::FastCorrelativeScanMatcherOptions3D
CreateFastCorrelativeScanMatcherOptions3D(LuaParameterDictionary* const table) {
  return common::ReadOptions<proto::FastCorrelativeScanMatcherOptions3D>(table);
}

proto::CeresScanMatcherOptions3D CreateCeresScanMatcherOptions3D(
    LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::CeresScanMatcherOptions3D>(table);
  // One weight, and optionally one table, per resolution: ..._0, ..._1, ...
  for (const std::string& key : Numbered("occupied_space_weight_", *table)) {
    options.add_occupied_space_weight(table->GetDouble(key));
  }
  for (const std::string& key :
       Numbered("intensity_cost_function_options_", *table)) {
    common::ReadFields(table->GetDictionary(key).get(),
                       options.add_intensity_cost_function_options());
  }
  *options.mutable_ceres_solver_options() = common::ReadTable(
      table, "ceres_solver_options", &common::CreateCeresSolverOptionsProto);
  return options;
}

}  // namespace scan_matching

namespace {

proto::SubmapsOptions3D ReadSubmapsOptions(
    LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::SubmapsOptions3D>(table);
  CHECK_GE(options.num_range_data(), 0);
  *options.mutable_range_data_inserter_options() = common::ReadTable(
      table, "range_data_inserter",
      &common::ReadOptions<proto::RangeDataInserterOptions3D>);
  return options;
}

}  // namespace

proto::LocalTrajectoryBuilderOptions3D CreateLocalTrajectoryBuilderOptions3D(
    LuaParameterDictionary* const table) {
  auto options =
      common::ReadOptions<proto::LocalTrajectoryBuilderOptions3D>(table);
  *options.mutable_high_resolution_adaptive_voxel_filter_options() =
      common::ReadTable(table, "high_resolution_adaptive_voxel_filter",
                        &sensor::CreateAdaptiveVoxelFilterOptions);
  *options.mutable_low_resolution_adaptive_voxel_filter_options() =
      common::ReadTable(table, "low_resolution_adaptive_voxel_filter",
                        &sensor::CreateAdaptiveVoxelFilterOptions);
  *options.mutable_real_time_correlative_scan_matcher_options() =
      common::ReadTable(
          table, "real_time_correlative_scan_matcher",
          &scan_matching::CreateRealTimeCorrelativeScanMatcherOptions);
  *options.mutable_ceres_scan_matcher_options() =
      common::ReadTable(table, "ceres_scan_matcher",
                        &scan_matching::CreateCeresScanMatcherOptions3D);
  *options.mutable_motion_filter_options() =
      common::ReadTable(table, "motion_filter", &CreateMotionFilterOptions);
  *options.mutable_pose_extrapolator_options() = common::ReadTable(
      table, "pose_extrapolator", &CreatePoseExtrapolatorOptions);
  *options.mutable_submaps_options() =
      common::ReadTable(table, "submaps", &ReadSubmapsOptions);
  return options;
}

}  // namespace mapping
}  // namespace cartographer
