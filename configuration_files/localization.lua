-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Localisation in a finished map (-load_state_filename) with all our modules that
-- improve it.
include "common_2d.lua"
include "front_end_default.lua"
include "loop_closure_default.lua"

-- Only the newest submaps of the recording are kept. A buffered loop is dropped
-- with its node: with the three submaps of stock, one drive in ten through an
-- office lost all of its loops and drifted by up to 0.13 m.
TRAJECTORY_BUILDER.pure_localization_trimmer = {
  max_submaps_to_keep = 8,
}
POSE_GRAPH.optimize_every_n_nodes = 20
-- While the pose in the map is unknown, every pair of a node and a submap of the
-- map is proposed; our loop closure decides which of them are searched.
POSE_GRAPH.global_sampling_ratio = 1.
-- The search structures of the whole map are needed again and again.
POSE_GRAPH.constraint_builder.cartographer_ext.search.max_cache_mb = 512

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
  -- The IMU of a recording that has one, once its turns are those of the scans.
  sensors = { use_recorded_imu = true },
}
