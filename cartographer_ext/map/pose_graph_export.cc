// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pose_graph_export.h"

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr int64_t kPerKind = 1000000;
constexpr int64_t kPerTrajectory = 2 * kPerKind;

absl::Status CheckId(const char* kind, const GraphId& id) {
  if (id.trajectory_id >= 0 && id.index >= 0 && id.index < kPerKind) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(kind, " ", ToString(id),
                   " cannot be numbered: indices must be below ", kPerKind));
}

}  // namespace

int64_t SubmapVertexId(const GraphId& id) {
  return id.trajectory_id * kPerTrajectory + id.index;
}

int64_t NodeVertexId(const GraphId& id) {
  return id.trajectory_id * kPerTrajectory + kPerKind + id.index;
}

absl::StatusOr<io::G2oGraph> ToG2o(const MapGraph& graph) {
  io::G2oGraph result;
  for (const auto& entry : graph.submaps) {
    const absl::Status status = CheckId("submap", entry.first);
    if (!status.ok()) return status;
    result.vertices[SubmapVertexId(entry.first)] = entry.second.global_pose;
  }
  for (const auto& entry : graph.nodes) {
    const absl::Status status = CheckId("node", entry.first);
    if (!status.ok()) return status;
    result.vertices[NodeVertexId(entry.first)] = entry.second.global_pose;
  }
  if (!graph.submaps.empty()) {
    result.fixed.insert(SubmapVertexId(graph.submaps.begin()->first));
  }
  for (const GraphConstraint& constraint : graph.constraints) {
    if (graph.submaps.count(constraint.submap_id) == 0 ||
        graph.nodes.count(constraint.node_id) == 0 ||
        !(constraint.translation_weight > 0.) ||
        !(constraint.rotation_weight > 0.)) {
      continue;
    }
    io::G2oEdge edge;
    edge.from = SubmapVertexId(constraint.submap_id);
    edge.to = NodeVertexId(constraint.node_id);
    edge.measurement = constraint.relative_pose;
    const double translation =
        constraint.translation_weight * constraint.translation_weight;
    const double rotation =
        constraint.rotation_weight * constraint.rotation_weight;
    edge.information =
        Eigen::Vector3d(translation, translation, rotation).asDiagonal();
    result.edges.push_back(edge);
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
