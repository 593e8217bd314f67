// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/decision_table.h"

#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

std::string Stamp(const io::TimeNs time) {
  const io::TimeNs magnitude = time < 0 ? -time : time;
  return absl::StrFormat("%s%d.%09d", time < 0 ? "-" : "",
                         magnitude / 1000000000, magnitude % 1000000000);
}

std::string Ids(const GraphConstraint& constraint) {
  return absl::StrCat(
      constraint.submap_id.trajectory_id, ",", constraint.submap_id.index, ",",
      constraint.node_id.trajectory_id, ",", constraint.node_id.index);
}

// Stamp of the node, empty where the graph does not have it.
std::string NodeStamp(const MapGraph& graph, const GraphId& id) {
  const auto it = graph.nodes.find(id);
  return it == graph.nodes.end() ? "" : Stamp(it->second.time);
}

std::string ResidualColumns(const MapGraph& graph,
                            const GraphConstraint& constraint) {
  const auto submap = graph.submaps.find(constraint.submap_id);
  const auto node = graph.nodes.find(constraint.node_id);
  if (submap == graph.submaps.end() || node == graph.nodes.end()) return ",";
  const Pose2 residual = Residual(constraint, submap->second, node->second);
  return absl::StrFormat("%.6f,%.6f", residual.translation().norm(),
                         std::abs(residual.theta));
}

std::string PoseColumns(const Pose2& pose) {
  return absl::StrFormat("%.6f,%.6f,%.6f", pose.x, pose.y, pose.theta);
}

constexpr char kIdColumns[] =
    "submap_trajectory_id,submap_index,node_trajectory_id,node_index";

}  // namespace

std::string ConstraintTable(const MapGraph& graph,
                            const LoopStatistics* const loops) {
  std::map<size_t, const LoopJudgement*> judgements;
  if (loops != nullptr) {
    for (const LoopJudgement& loop : loops->loops) {
      judgements[loop.constraint] = &loop;
    }
  }
  std::string table = absl::StrCat(
      kIdColumns,
      ",kind,node_time,x,y,theta,translation_weight,rotation_weight,"
      "residual_translation,residual_rotation,switched_off",
      loops == nullptr ? "" : ",truth,error_translation,error_rotation", "\n");
  for (size_t i = 0; i < graph.constraints.size(); ++i) {
    const GraphConstraint& constraint = graph.constraints[i];
    absl::StrAppend(
        &table, Ids(constraint), ",", constraint.is_loop ? "inter" : "intra",
        ",", NodeStamp(graph, constraint.node_id), ",",
        PoseColumns(constraint.relative_pose), ",",
        constraint.translation_weight, ",", constraint.rotation_weight, ",",
        ResidualColumns(graph, constraint), ",",
        constraint.switched_off ? 1 : 0);
    if (loops != nullptr) {
      const auto it = judgements.find(i);
      if (it == judgements.end() ||
          it->second->verdict == LoopVerdict::kUnknown) {
        absl::StrAppend(&table, ",unknown,,");
      } else {
        absl::StrAppendFormat(
            &table, ",%s,%.6f,%.6f",
            it->second->verdict == LoopVerdict::kCorrect ? "correct" : "wrong",
            it->second->translation_error, it->second->rotation_error);
      }
    }
    absl::StrAppend(&table, "\n");
  }
  return table;
}

std::string DecisionTable(const MapGraph& graph) {
  std::string table = absl::StrCat(
      kIdColumns,
      ",node_time,verdict,x,y,theta,translation_weight,rotation_weight,"
      "residual_translation,residual_rotation\n");
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) continue;
    absl::StrAppend(
        &table, Ids(constraint), ",", NodeStamp(graph, constraint.node_id),
        constraint.switched_off ? ",switched_off," : ",accepted,",
        PoseColumns(constraint.relative_pose), ",",
        constraint.translation_weight, ",", constraint.rotation_weight, ",",
        ResidualColumns(graph, constraint), "\n");
  }
  return table;
}

}  // namespace evaluation
}  // namespace cartographer_ext
