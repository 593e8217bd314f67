-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Table 3 of the 2025 paper, C: only the confidence in the information of a
-- loop, taken from the grid score.
include "common_2d.lua"
include "loop_closure_paper_2025.lua"

POSE_GRAPH.constraint_builder.cartographer_ext.temporal_verification.enabled =
  false
POSE_GRAPH.constraint_builder.cartographer_ext.dynamic_threshold.enabled = false
POSE_GRAPH.constraint_builder.cartographer_ext.fusion.enabled = false

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}
