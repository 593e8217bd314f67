-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Our loop closure with its defaults, to be included after the stock
-- files. One set of values for all data sets.
if CARTOGRAPHER_EXT == nil then
  include "cartographer_ext.lua"
end

POSE_GRAPH.constraint_builder.cartographer_ext =
  CARTOGRAPHER_EXT.constraint_builder

-- Local SLAM has already used the odometry and corrected it. With the weight of
-- local SLAM, odometry would pull the map towards the systematic errors of the
-- wheels.
POSE_GRAPH.optimization_problem.odometry_translation_weight = 1e1
POSE_GRAPH.optimization_problem.odometry_rotation_weight = 1e1
