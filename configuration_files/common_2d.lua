-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Common part of all complete configurations: the stock values, set up for a 2D
-- laser with or without wheel odometry, for any data set.
include "map_builder.lua"
include "trajectory_builder.lua"

MAP_BUILDER.use_trajectory_builder_2d = true

-- Laser. The readings between max_range and the laser's own limit become short
-- free rays. Readings closer than min_range are the robot itself.
TRAJECTORY_BUILDER_2D.use_imu_data = false
TRAJECTORY_BUILDER_2D.min_range = 0.1
TRAJECTORY_BUILDER_2D.max_range = 30.

-- One log line per match and histograms at every optimisation are for debugging.
POSE_GRAPH.constraint_builder.log_matches = false
POSE_GRAPH.log_residual_histograms = false
