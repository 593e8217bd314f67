-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Table 3 of the 2025 paper, B: only the fusion of the scores. It needs the
-- temporal score, which has no threshold here.
include "common_2d.lua"
include "loop_closure_paper_2025.lua"

POSE_GRAPH.constraint_builder.cartographer_ext.dynamic_threshold.enabled = false
POSE_GRAPH.constraint_builder.cartographer_ext.information.enabled = false

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}
