-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- From stock Cartographer, with our local SLAM and our loop closure as choices
-- among the keys. The evaluation of loops and scans generalises to other
-- buildings, unlike any value of min_score, so start with this search; stock.lua
-- is for users who have to keep stock Cartographer.
--   cartographer_ext_tune -search_filename=configuration_files/tuning/blocks.lua
--     -inputs=... -holdout=... -method=halving -budget_minutes=30
return {
  configuration = "stock.lua",
  objective = "relations",
  -- One folded map must not dominate the other recordings.
  aggregation = "geometric_mean",
  no_input_worse = true,
  parameters = {
    { include = "front_end", choices = { "", "front_end_default.lua" } },
    { include = "loop_closure", choices = { "", "loop_closure_default.lua" } },
    { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight",
      range = { 3., 100. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.rotation_weight",
      range = { 3., 300. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.submaps.num_range_data",
      range = { 60, 160 }, integer = true },
    { key = "POSE_GRAPH.constraint_builder.min_score",
      range = { 0.5, 0.7 } },
    { key = "POSE_GRAPH.optimization_problem.huber_scale",
      range = { 1., 100. }, scale = "log" },
    { key = "POSE_GRAPH.optimize_every_n_nodes",
      range = { 45, 180 }, integer = true },
  },
}
