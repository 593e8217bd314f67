-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Our loop closure with every stage off: Cartographer's search, with every
-- match accepted. Basis of the ablations and literal presets. To be included
-- after the stock files.
if CARTOGRAPHER_EXT == nil then
  include "cartographer_ext.lua"
end

POSE_GRAPH.constraint_builder.cartographer_ext =
  CARTOGRAPHER_EXT.constraint_builder

local loops = POSE_GRAPH.constraint_builder.cartographer_ext
loops.search.enabled = false
loops.temporal_verification.enabled = false
loops.dynamic_threshold.enabled = false
loops.fusion.enabled = false
loops.information.enabled = false
loops.compatible_subset.enabled = false
loops.innovation_veto.enabled = false
loops.localization.enabled = false
