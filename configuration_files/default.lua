-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- The default of cartographer_ext: all our modules that improve maps, with one
-- set of values for all data sets.
include "common_2d.lua"
include "cartographer_ext_2d.lua"

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
  -- The IMU of a recording that has one, once its turns are those of the scans.
  sensors = { use_recorded_imu = true },
}
