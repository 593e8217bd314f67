-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Loop closure as the 2025 paper on the optimised Cartographer prints it
-- (equations 1 to 11), with Cartographer's fixed search window and nothing that
-- is not in the paper. To be included after the stock files.
include "loop_closure_stages_off.lua"

local loops = POSE_GRAPH.constraint_builder.cartographer_ext

-- Section 1.2, equation 4: 4 to 6 nodes.
loops.temporal_verification.enabled = true
loops.temporal_verification.window_base = 4
loops.temporal_verification.window_gamma = 0.3
loops.paper_mode.temporal_verification = true

-- Equations 1 to 3.
loops.dynamic_threshold.enabled = true
loops.dynamic_threshold.low = 0.5
loops.dynamic_threshold.span = 0.2
loops.paper_mode.dynamic_threshold = true

-- Equations 5 to 7.
loops.fusion.enabled = true
loops.fusion.min_final_score = 0.55
loops.paper_mode.fusion = true

-- Equations 8 to 11.
loops.information.enabled = true
loops.information.alpha = 1.2
loops.information.beta = 1.5
loops.information.reference_score = 1.
