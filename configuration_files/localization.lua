-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Localisation in a finished map (-load_state_filename) with everything of ours
-- that pays.
include "common_2d.lua"
include "front_end_default.lua"
include "loop_closure_default.lua"

-- Of the recording the newest submaps only are kept. A loop that waits for
-- others to confirm it goes with its node: with the three submaps of stock, one
-- drive in ten through an office lost all of them and drifted by up to 0.13 m.
TRAJECTORY_BUILDER.pure_localization_trimmer = {
  max_submaps_to_keep = 8,
}
POSE_GRAPH.optimize_every_n_nodes = 20
-- Every pair of a node and a submap of the map is offered while the place in it
-- is not known; which of them are searched is decided by our loop closure.
POSE_GRAPH.global_sampling_ratio = 1.
-- The search structures of the whole map are needed again and again.
POSE_GRAPH.constraint_builder.cartographer_ext.search.max_cache_mb = 512

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}
