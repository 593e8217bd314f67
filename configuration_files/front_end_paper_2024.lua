-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Local SLAM of the 2024 paper on improved graph optimisation, literally:
-- adaptive feature points (eq. 1 to 4), preintegration if there is an IMU
-- (eq. 5 to 13; set use_imu_data), eigenvalue ratio of the match covariance (eq.
-- 17 to 19), and nothing that is not in the paper. To be included after the
-- stock files.
if CARTOGRAPHER_EXT == nil then
  include "cartographer_ext.lua"
end

TRAJECTORY_BUILDER_2D.cartographer_ext = CARTOGRAPHER_EXT.trajectory_builder_2d
TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext =
  CARTOGRAPHER_EXT.ceres_scan_matcher

TRAJECTORY_BUILDER_2D.cartographer_ext.paper_mode.adaptive_features = true
TRAJECTORY_BUILDER_2D.cartographer_ext.time_offset.estimate = false
TRAJECTORY_BUILDER_2D.cartographer_ext.calibration.estimate_odometry_scale = false
TRAJECTORY_BUILDER_2D.cartographer_ext.calibration.estimate_rotation = false
TRAJECTORY_BUILDER_2D.cartographer_ext.fault_check.enabled = false
TRAJECTORY_BUILDER_2D.cartographer_ext.search.enabled = false
TRAJECTORY_BUILDER_2D.cartographer_ext.wall_filling.enabled = false
TRAJECTORY_BUILDER_2D.cartographer_ext.range_smoothing.enabled = false
TRAJECTORY_BUILDER_2D.cartographer_ext.beam_order.estimate = false
TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext.paper_mode
  .eigenvalue_ratio = true
