-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- For cartographer_ros: the robot of cartographer_ext_robot.lua in a finished map
-- (-load_state_filename). The map is frozen; of the run only the newest submaps
-- are kept.
include "cartographer_ext_robot.lua"

-- A loop that waits for others to confirm it goes with its node: with the three
-- submaps of stock some drives lose all of theirs, and drift.
TRAJECTORY_BUILDER.pure_localization_trimmer = { max_submaps_to_keep = 8 }
POSE_GRAPH.optimize_every_n_nodes = 20
-- Our loop closure decides which pairs are searched.
POSE_GRAPH.global_sampling_ratio = 1.
-- The search structures of the whole map are needed again and again.
POSE_GRAPH.constraint_builder.cartographer_ext.search.max_cache_mb = 512
return options
