-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Rows of identical shelves: the neighbouring aisle looks the same for the whole
-- length of a row, and only the path distinguishes them. Loops need a good
-- prediction, and unconfirmed ones are rejected.
include "common_2d.lua"
include "front_end_default.lua"
include "loop_closure_default.lua"

POSE_GRAPH.constraint_builder.cartographer_ext.compatible_subset.single_strong =
  false
POSE_GRAPH.constraint_builder.cartographer_ext.compatible_subset.weak_prior_sigma =
  0.5
POSE_GRAPH.constraint_builder.cartographer_ext.search.global_search = false

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
  -- The IMU of a recording that has one, once its turns are those of the scans.
  sensors = { use_recorded_imu = true },
}
