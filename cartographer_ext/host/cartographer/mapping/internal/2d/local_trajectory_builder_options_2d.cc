// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/scan_matching/real_time_correlative_scan_matcher.h"
#include "cartographer/mapping/pose_extrapolator_interface.h"
#include "cartographer/sensor/internal/voxel_filter.h"

namespace cartographer {
namespace mapping {

proto::LocalTrajectoryBuilderOptions2D CreateLocalTrajectoryBuilderOptions2D(
    common::LuaParameterDictionary* const table) {
  auto options =
      common::ReadOptions<proto::LocalTrajectoryBuilderOptions2D>(table);
  // In the order in which they apply to a scan.
  *options.mutable_pose_extrapolator_options() = common::ReadTable(
      table, "pose_extrapolator", &CreatePoseExtrapolatorOptions);
  *options.mutable_adaptive_voxel_filter_options() =
      common::ReadTable(table, "adaptive_voxel_filter",
                        &sensor::CreateAdaptiveVoxelFilterOptions);
  *options.mutable_real_time_correlative_scan_matcher_options() =
      common::ReadTable(
          table, "real_time_correlative_scan_matcher",
          &scan_matching::CreateRealTimeCorrelativeScanMatcherOptions);
  *options.mutable_ceres_scan_matcher_options() =
      common::ReadTable(table, "ceres_scan_matcher",
                        &scan_matching::CreateCeresScanMatcherOptions2D);
  *options.mutable_motion_filter_options() =
      common::ReadTable(table, "motion_filter", &CreateMotionFilterOptions);
  *options.mutable_submaps_options() =
      common::ReadTable(table, "submaps", &CreateSubmapsOptions2D);
  *options.mutable_loop_closure_adaptive_voxel_filter_options() =
      common::ReadTable(table, "loop_closure_adaptive_voxel_filter",
                        &sensor::CreateAdaptiveVoxelFilterOptions);
  return options;
}

}  // namespace mapping
}  // namespace cartographer
