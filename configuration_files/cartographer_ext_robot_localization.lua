-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- For cartographer_ros: the robot of cartographer_ext_robot.lua in a finished map
-- (-load_state_filename). Nothing of the map changes; of the run only the newest
-- submaps are kept.
include "cartographer_ext_robot.lua"

TRAJECTORY_BUILDER.pure_localization_trimmer = { max_submaps_to_keep = 3 }
POSE_GRAPH.optimize_every_n_nodes = 20
-- Which pairs are searched is decided by our loop closure.
POSE_GRAPH.global_sampling_ratio = 1.
return options
