// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What is known about a map, as numbers for programs and as a table for people.
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
  // Any of them may be absent: without truth there are only the loops of the
  // graph, without a graph only the trajectory.
  absl::optional<RelationsMetric> relations;
  // At the nodes, interpolated in time, when `relations` are those of another
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
  // Each a sentence without full stop.
  std::vector<std::string> reasons;
};

// A map counts as broken when more than 2 % of the loop relations are off by
// more than half a metre, or when the trajectory is more than a metre from the
// reference (root mean square); as doubtful at a tenth and a half of that.
// Without any truth the self-consistency of the map decides, where it is known;
// else the map is doubtful when more than 2 % of the loops disagree with the
// optimised graph by more than half a metre.
//
// There is one verdict: where the map by itself would be called otherwise than
// truth has it, the reasons say so in these words, and no reason says another
// verdict.
Verdict Judge(const Evaluation& evaluation);

nlohmann::ordered_json ToJson(const Statistics& statistics);
nlohmann::ordered_json ToJson(const Evaluation& evaluation);

// Several lines, the last one ended.
std::string ToText(const Evaluation& evaluation);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_EVALUATION_REPORT_H_
