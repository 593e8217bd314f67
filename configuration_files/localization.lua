-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Localisation in a finished map (-load_state_filename) with everything of ours
-- that pays.
include "common_2d.lua"
include "front_end_default.lua"
include "loop_closure_default.lua"

-- Of the recording the newest submaps only are kept.
TRAJECTORY_BUILDER.pure_localization_trimmer = {
  max_submaps_to_keep = 3,
}
POSE_GRAPH.optimize_every_n_nodes = 20

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}
