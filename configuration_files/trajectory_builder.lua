-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Stock values.
include "trajectory_builder_2d.lua"
include "trajectory_builder_3d.lua"

TRAJECTORY_BUILDER = {
  trajectory_builder_2d = TRAJECTORY_BUILDER_2D,
  trajectory_builder_3d = TRAJECTORY_BUILDER_3D,
  collate_fixed_frame = true,
  collate_landmarks = false,
}
