-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Stock values. Exactly one of the two use_ switches must be set to true.
include "pose_graph.lua"

MAP_BUILDER = {
  use_trajectory_builder_2d = false,
  use_trajectory_builder_3d = false,
  num_background_threads = 4,
  pose_graph = POSE_GRAPH,
  collate_by_trajectory = false,
}
