-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- The grid search of section 1.2 of the 2025 paper: gamma of the variable
-- window (equation 4) from 0.1 to 0.5, judged by the accuracy of loop
-- detection. The paper takes 0.3.
--   scripts/reproduce c_gamma
return {
  configuration = "paper_2025.lua",
  objective = "precision_at_recall",
  target_recall = 0.5,
  parameters = {
    { key = "POSE_GRAPH.constraint_builder.cartographer_ext.temporal_verification.window_gamma",
      range = { 0.1, 0.5 }, steps = 5 },
  },
}
