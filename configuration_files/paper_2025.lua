-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- The 2025 paper on the optimised Cartographer, literally; local SLAM and
-- optimisation are Cartographer's.
include "common_2d.lua"
include "loop_closure_paper_2025.lua"

return {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
}
