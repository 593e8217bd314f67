// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Evaluation of a map, as JSON and as a table.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_REPORT_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_REPORT_H_

#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"
#include "cartographer_ext/map/verdict/self_consistency.h"
#include "cartographer_ext/metrics/relations_metric.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

struct Evaluation {
  // Any of them may be absent: without ground truth there are only the loops of
  // the graph, without a graph only the trajectory.
  absl::optional<RelationsMetric> relations;
  // At the nodes, interpolated in time, if `relations` are those of another
  // trajectory.
  absl::optional<RelationsMetric> node_relations;
  absl::optional<TrajectoryErrors> trajectory;
  absl::optional<LoopStatistics> loops;
  absl::optional<SelfConsistency> consistency;
  double trajectory_metres = 0.;
};

struct Verdict {
  // "sound", "doubtful", "broken", or "unknown" without any evidence.
  std::string word;
  // Sentences without full stop.
  std::vector<std::string> reasons;
};

// A map is broken if more than 2 % of the loop relations are off by more than
// half a metre, or if the trajectory is more than a metre from the reference
// (root mean square); it is doubtful from 0.2 % or half a metre on. Without
// ground truth the self-consistency of the map decides, if available; otherwise
// the map is doubtful if more than 2 % of the loops disagree with the optimised
// graph by more than half a metre.
//
// There is one verdict: if self-consistency alone would give another one than
// ground truth, the reasons mention it, and no reason names a different
// verdict.
Verdict Judge(const Evaluation& evaluation);

nlohmann::ordered_json ToJson(const Statistics& statistics);
nlohmann::ordered_json ToJson(const Evaluation& evaluation);

// Several lines of text, with a final line break.
std::string ToText(const Evaluation& evaluation);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_REPORT_H_
