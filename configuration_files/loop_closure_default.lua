-- SPDX-FileCopyrightText: 2026 The cartographer_ext authors
-- SPDX-License-Identifier: Apache-2.0
--
-- Loop closure of ours with its defaults, to be included behind the stock
-- files. One set of values for all data sets.
include "cartographer_ext.lua"

POSE_GRAPH.constraint_builder.cartographer_ext =
  CARTOGRAPHER_EXT.constraint_builder
