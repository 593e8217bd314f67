// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_DECISION_TABLE_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_DECISION_TABLE_H_

#include <string>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"

namespace cartographer_ext {
namespace evaluation {

// The constraints of a graph as CSV with a header line, one per line: ids, kind
// (intra, inter), stamp of the node in seconds, relative pose, weights,
// residual against the optimised poses in metres and radians, and 1 for a loop
// disabled by the optimisation. With `loops` also the verdict by ground truth
// and the errors against it.
std::string ConstraintTable(const MapGraph& graph, const LoopStatistics* loops);

// The loop constraints alone, as decisions: "accepted" or "switched_off".
std::string DecisionTable(const MapGraph& graph);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_DECISION_TABLE_H_
