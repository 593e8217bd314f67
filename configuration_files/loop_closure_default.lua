-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Loop closure of ours with its defaults, to be included behind the stock
-- files. One set of values for all data sets.
if CARTOGRAPHER_EXT == nil then
  include "cartographer_ext.lua"
end

POSE_GRAPH.constraint_builder.cartographer_ext =
  CARTOGRAPHER_EXT.constraint_builder

-- Local SLAM has used the odometry already and corrected it. Weighed as heavily
-- as local SLAM it pulls the map towards the errors of the wheels, which are the
-- same all along a run.
POSE_GRAPH.optimization_problem.odometry_translation_weight = 1e1
POSE_GRAPH.optimization_problem.odometry_rotation_weight = 1e1
