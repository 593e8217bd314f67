-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Local SLAM for long corridors and a robot whose odometry was calibrated:
-- along degenerate directions it follows the odometry sooner, and a smaller
-- change of speed is taken for slip. To be included after the stock files.
include "front_end_default.lua"

CARTOGRAPHER_EXT.trajectory_builder_2d.odometry.translation_noise = 0.005
CARTOGRAPHER_EXT.trajectory_builder_2d.odometry.translation_noise_per_metre =
  0.03
CARTOGRAPHER_EXT.trajectory_builder_2d.fault_check.max_acceleration = 0.8
