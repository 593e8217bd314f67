-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- The calibration of section 1.4 of the 2025 paper: exponents of the weights
-- (equation 9). The paper fixes alpha and varies beta, and uses 1.2 and 1.5;
-- here a few values of alpha are tried as well.
--   scripts/reproduce c_alpha_beta
return {
  configuration = "paper_2025.lua",
  objective = "relations",
  parameters = {
    { key = "POSE_GRAPH.constraint_builder.cartographer_ext.information.alpha",
      choices = { 0.9, 1.2, 1.5 } },
    { key = "POSE_GRAPH.constraint_builder.cartographer_ext.information.beta",
      range = { 0.9, 2.1 }, steps = 5 },
  },
}
