// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Consistency of loops with each other, independent of the optimisation. Two
// loops close a cycle with two short pieces of local SLAM: from node i to node
// k, and from submap a to submap b,
//
//   (a <- i) * (i <- k by local SLAM) * (b <- k)^-1 * (b <- a by local SLAM),
//
// which is the identity if both loops are right. Only pieces that are short
// enough for local SLAM to be accurate are used, so that a residual is due to
// the loops.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_LOOP_CYCLES_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_LOOP_CYCLES_H_

#include <vector>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/metrics/statistics.h"

namespace cartographer_ext {
namespace evaluation {

struct LoopCycleOptions {
  int max_node_gap = 30;
  int max_submap_gap = 1;
  double max_metres = 5.;  // of local SLAM between the nodes
  // Each loop is tested against at most this many of its successors.
  int max_partners = 8;
  double consistent_translation = 0.3;        // metres
  double consistent_rotation = DegToRad(5.);  // radians
};

struct LoopCycles {
  int64_t cycles = 0;
  int64_t inconsistent = 0;
  Statistics translation;  // metres
  Statistics rotation_degrees;
  // For each loop in the order of the constraints: the share of its cycles that
  // are open, and the number of its cycles.
  std::vector<double> inconsistent_fraction;
  std::vector<int> partners;
  double fraction() const {
    return cycles == 0 ? 0.
                       : static_cast<double>(inconsistent) /
                             static_cast<double>(cycles);
  }
};

LoopCycles ComputeLoopCycles(const MapGraph& graph,
                             const LoopCycleOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_LOOP_CYCLES_H_
