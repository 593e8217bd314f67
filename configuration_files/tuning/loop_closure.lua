-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Loop closure only, so finished maps (.pbstream) may be inputs:
--   cartographer_ext_tune -search_filename=configuration_files/tuning/loop_closure.lua
--     -inputs=a.pbstream=a.relations,b.pbstream=b.tum -budget_minutes=20
-- Without ground truth: -objective=self_consistency.
return {
  configuration = "stock.lua",
  objective = "relations",
  parameters = {
    { key = "POSE_GRAPH.constraint_builder.min_score",
      range = { 0.45, 0.75 } },
    { key = "POSE_GRAPH.constraint_builder.sampling_ratio",
      range = { 0.02, 0.5 }, scale = "log" },
    { key = "POSE_GRAPH.constraint_builder.max_constraint_distance",
      range = { 5., 30. } },
    { key = "POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher.linear_search_window",
      range = { 2., 12. } },
    { key = "POSE_GRAPH.constraint_builder.loop_closure_translation_weight",
      range = { 1e2, 1e5 }, scale = "log" },
    { key = "POSE_GRAPH.constraint_builder.loop_closure_rotation_weight",
      range = { 1e3, 1e6 }, scale = "log" },
    { key = "POSE_GRAPH.optimization_problem.huber_scale",
      range = { 0.1, 1e3 }, scale = "log" },
    { key = "POSE_GRAPH.optimize_every_n_nodes",
      range = { 30, 180 }, integer = true },
  },
}
