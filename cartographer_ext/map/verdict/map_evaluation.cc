// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/map_evaluation.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

absl::Status Annotate(const absl::Status& status, const std::string& name) {
  return absl::Status(status.code(),
                      absl::StrCat(name, ": ", status.message()));
}

LoopStatistics EvaluateLoops(const MapGraph& graph, const GroundTruth& truth,
                             const LoopStatisticsOptions& options) {
  if (truth.reference.has_value()) {
    return ComputeLoopStatistics(graph, *truth.reference, options);
  }
  if (truth.relations.has_value()) {
    return ComputeLoopStatistics(graph, *truth.relations, options);
  }
  return ComputeLoopStatistics(graph);
}

absl::Status EvaluateRelations(const MapToEvaluate& map,
                               const Trajectory& nodes,
                               const GroundTruth& truth,
                               const MapEvaluationOptions& options,
                               Evaluation* const result) {
  // Nodes are interpolated in time, as Cartographer's own tool does.
  RelationsMetricOptions interpolate = options.relations;
  interpolate.stamp_tolerance = 0;
  const bool has_scans = map.scans != nullptr;
  auto metric =
      ComputeRelationsMetric(has_scans ? *map.scans : nodes, *truth.relations,
                             has_scans ? options.relations : interpolate);
  if (!metric.ok()) return Annotate(metric.status(), truth.relations_name);
  result->relations = *std::move(metric);
  if (has_scans && !nodes.empty()) {
    auto at_nodes =
        ComputeRelationsMetric(nodes, *truth.relations, interpolate);
    if (at_nodes.ok()) result->node_relations = *std::move(at_nodes);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Evaluation> EvaluateMap(const MapToEvaluate& map,
                                       const GroundTruth& truth,
                                       const MapEvaluationOptions& options) {
  Evaluation result;
  Trajectory nodes;
  if (map.graph != nullptr) {
    nodes = map.graph->GlobalTrajectory(options.trajectory_id);
    if (nodes.empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat("trajectory ", options.trajectory_id, " has no nodes"));
    }
  }
  const Trajectory& estimate = map.scans != nullptr ? *map.scans : nodes;
  result.trajectory_metres = estimate.Length();
  if (truth.relations.has_value()) {
    const absl::Status status =
        EvaluateRelations(map, nodes, truth, options, &result);
    if (!status.ok()) return status;
  }
  if (truth.reference.has_value()) {
    auto errors =
        ComputeTrajectoryErrors(estimate, *truth.reference, options.trajectory);
    if (!errors.ok()) return Annotate(errors.status(), truth.reference_name);
    result.trajectory = *std::move(errors);
  }
  if (map.graph == nullptr) return result;
  result.loops = EvaluateLoops(*map.graph, truth, options.loops);
  if (map.contents != nullptr) {
    static const std::map<int, Trajectory>* const kNone =
        new std::map<int, Trajectory>;
    result.consistency = AssessSelfConsistency(
        *map.graph, *map.contents,
        map.odometry != nullptr ? *map.odometry : *kNone, options.consistency);
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
