-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Our local SLAM with its defaults, to be included after the stock files.
-- One set of values for all data sets.
if CARTOGRAPHER_EXT == nil then
  include "cartographer_ext.lua"
end

TRAJECTORY_BUILDER_2D.cartographer_ext = CARTOGRAPHER_EXT.trajectory_builder_2d
TRAJECTORY_BUILDER_2D.ceres_scan_matcher.cartographer_ext =
  CARTOGRAPHER_EXT.ceres_scan_matcher

-- Grids that converge sooner, so that scans are matched against complete walls.
TRAJECTORY_BUILDER_2D.submaps.range_data_inserter
  .probability_grid_range_data_inserter.hit_probability = 0.6
TRAJECTORY_BUILDER_2D.submaps.range_data_inserter
  .probability_grid_range_data_inserter.miss_probability = 0.48
