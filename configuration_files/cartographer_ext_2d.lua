-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Enables cartographer_ext for a 2D robot. Include it in the robot's own
-- Lua file, after the stock files and the robot's changes to them, as the last
-- line before `return options`. It needs a Cartographer built with the swap.
--
-- What it changes:
--   local SLAM      TRAJECTORY_BUILDER_2D.cartographer_ext and
--                   TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext
--                   on; hit_probability 0.6 and miss_probability 0.48 (a grid
--                   that converges sooner)
--   loop closure    POSE_GRAPH.constraint_builder.cartographer_ext on;
--                   odometry_translation_weight and odometry_rotation_weight
--                   of POSE_GRAPH.optimization_problem 1e1 (local SLAM has
--                   used the odometry already)
--   optimisation    POSE_GRAPH.optimization_problem.cartographer_ext on, without
--                   its selection of loops: during the run to a millimetre, and
--                   at the end loops are put in force
-- Everything else stays as in the robot's file. Our values can be changed in
-- lines after the include.
include "front_end_default.lua"
include "loop_closure_default.lua"

POSE_GRAPH.optimization_problem.cartographer_ext =
  CARTOGRAPHER_EXT.optimization_problem
-- The loops have been selected before.
POSE_GRAPH.optimization_problem.cartographer_ext.robust_loops = false
POSE_GRAPH.optimization_problem.cartographer_ext.odometry_check = false
-- Searches for loops need no more.
POSE_GRAPH.optimization_problem.cartographer_ext.running_tolerance = 0.001
