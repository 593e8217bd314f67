// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Evaluates a map by all available data: relations, a reference trajectory, its
// loops, its contents. Used for stored maps and for the results of re-runs.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_MAP_EVALUATION_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_MAP_EVALUATION_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"
#include "cartographer_ext/metrics/relations_metric.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"

namespace cartographer_ext {
namespace evaluation {

// The available ground truth; names are for messages.
struct GroundTruth {
  absl::optional<std::vector<Relation>> relations;
  std::string relations_name;
  absl::optional<Trajectory> reference;
  std::string reference_name;
};

struct MapEvaluationOptions {
  int trajectory_id = 0;  // the one compared with ground truth
  RelationsMetricOptions relations;
  TrajectoryMetricsOptions trajectory;
  LoopStatisticsOptions loops;
  SelfConsistencyOptions consistency;
};

struct MapToEvaluate {
  // Any may be null, but not both of the first two.
  const MapGraph* graph = nullptr;
  const Trajectory* scans =
      nullptr;  // a pose at every scan; takes precedence over nodes
  const MapContents* contents = nullptr;  // for self-consistency; with `graph`
  const std::map<int, Trajectory>* odometry = nullptr;
};

// Errors: the ground truth does not overlap with the trajectory (names its
// file), or the trajectory has no nodes.
absl::StatusOr<Evaluation> EvaluateMap(const MapToEvaluate& map,
                                       const GroundTruth& truth,
                                       const MapEvaluationOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_MAP_EVALUATION_H_
