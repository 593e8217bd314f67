-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- The 2024 paper on improved graph optimisation: its local SLAM, its subset of
-- compatible loops with a fixed bound (eq. 20, 21), and its odometry check after
-- the optimisation.
include "common_2d.lua"
include "front_end_paper_2024.lua"
include "loop_closure_stages_off.lua"

local loops = POSE_GRAPH.constraint_builder.cartographer_ext
loops.compatible_subset.enabled = true
loops.paper_mode.compatible_subset = true

POSE_GRAPH.optimization_problem.cartographer_ext =
  CARTOGRAPHER_EXT.optimization_problem
POSE_GRAPH.optimization_problem.cartographer_ext.robust_loops = false
POSE_GRAPH.optimization_problem.cartographer_ext.odometry_check = true
POSE_GRAPH.optimization_problem.cartographer_ext.loops_in_force = false

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}
