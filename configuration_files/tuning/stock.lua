-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- The keys of stock Cartographer that matter most for 2D maps of buildings:
-- local SLAM first, then loop closure.
--   cartographer_ext_tune -search_filename=configuration_files/tuning/stock.lua
--     -inputs=... -holdout=... -budget_minutes=30
return {
  configuration = "stock.lua",
  objective = "relations",
  parameters = {
    { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.translation_weight",
      range = { 0.3, 300. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.ceres_scan_matcher.rotation_weight",
      range = { 0.3, 1000. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.use_online_correlative_scan_matching",
      choices = { false, true } },
    { key = "TRAJECTORY_BUILDER_2D.real_time_correlative_scan_matcher.translation_delta_cost_weight",
      range = { 0.1, 30. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.real_time_correlative_scan_matcher.rotation_delta_cost_weight",
      range = { 0.1, 30. }, scale = "log" },
    { key = "TRAJECTORY_BUILDER_2D.submaps.num_range_data",
      range = { 30, 180 }, integer = true },
    { key = "POSE_GRAPH.constraint_builder.min_score",
      range = { 0.45, 0.75 } },
    { key = "POSE_GRAPH.constraint_builder.sampling_ratio",
      range = { 0.02, 0.3 }, scale = "log" },
    { key = "POSE_GRAPH.constraint_builder.max_constraint_distance",
      range = { 5., 30. } },
    { key = "POSE_GRAPH.constraint_builder.loop_closure_translation_weight",
      range = { 1e2, 1e5 }, scale = "log" },
    { key = "POSE_GRAPH.optimization_problem.huber_scale",
      range = { 0.1, 1e3 }, scale = "log" },
    { key = "POSE_GRAPH.optimization_problem.odometry_translation_weight",
      range = { 1e2, 1e6 }, scale = "log" },
    { key = "POSE_GRAPH.optimize_every_n_nodes",
      range = { 30, 180 }, integer = true },
  },
}
