-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- For cartographer_ros: a planar laser that is carried, pushed or worn, without
-- odometry. With an IMU set use_imu_data to true and tracking_frame to the frame
-- of the IMU.
include "cartographer_ext_robot.lua"

options.use_odometry = false
-- No other node publishes odom.
options.provide_odom_frame = true
options.published_frame = "base_link"
-- The pose of the robot itself can be extrapolated to the present.
options.use_pose_extrapolator = true

return options
