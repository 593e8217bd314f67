-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Long corridors, where places repeat every few metres along the path: a longer
-- piece of the path must match, and a loop with a weak prediction needs more
-- confirmation.
include "common_2d.lua"
include "front_end_corridor.lua"
include "loop_closure_default.lua"

POSE_GRAPH.constraint_builder.cartographer_ext.temporal_verification.window_base =
  20
POSE_GRAPH.constraint_builder.cartographer_ext.compatible_subset.weak_prior_revisits =
  4

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
  -- The IMU of a recording that has one, once its turns are those of the scans.
  sensors = { use_recorded_imu = true },
}
