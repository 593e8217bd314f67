// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/map_relations.h"

#include <cmath>
#include <limits>
#include <map>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using Nodes = std::map<GraphId, GraphNode>;

double Distance(const GraphNode& a, const GraphNode& b) {
  return (a.global_tracking_pose.translation() -
          b.global_tracking_pose.translation())
      .norm();
}

io::StampedRelation Relate(const GraphNode& from, const GraphNode& to) {
  io::StampedRelation relation;
  relation.time1 = from.time;
  relation.time2 = to.time;
  relation.relative =
      from.global_tracking_pose.inverse() * to.global_tracking_pose;
  return relation;
}

// The nodes inserted into each submap.
std::map<GraphId, std::vector<GraphId>> NodesOfSubmaps(const MapGraph& graph) {
  std::map<GraphId, std::vector<GraphId>> nodes;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop) {
      nodes[constraint.submap_id].push_back(constraint.node_id);
    }
  }
  return nodes;
}

// By the node that closes it, the node that it leads to: of the submaps that
// the node was matched with the nearest node long before or after.
std::map<GraphId, GraphId> LoopPartners(const MapGraph& graph,
                                        const MapRelationsOptions& options) {
  const auto members = NodesOfSubmaps(graph);
  std::map<GraphId, GraphId> partners;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (!constraint.is_loop || constraint.switched_off ||
        constraint.node_id.trajectory_id != options.trajectory_id ||
        constraint.submap_id.trajectory_id != options.trajectory_id) {
      continue;
    }
    const auto closing = graph.nodes.find(constraint.node_id);
    const auto inside = members.find(constraint.submap_id);
    if (closing == graph.nodes.end() || inside == members.end()) continue;
    const auto before = partners.find(constraint.node_id);
    double nearest =
        before == partners.end()
            ? std::numeric_limits<double>::infinity()
            : Distance(closing->second, graph.nodes.at(before->second));
    for (const GraphId& id : inside->second) {
      const auto node = graph.nodes.find(id);
      if (node == graph.nodes.end() ||
          std::abs(node->second.time - closing->second.time) <
              options.min_loop_time) {
        continue;
      }
      const double distance = Distance(closing->second, node->second);
      if (distance < nearest) {
        nearest = distance;
        partners[constraint.node_id] = id;
      }
    }
  }
  return partners;
}

}  // namespace

std::vector<io::StampedRelation> MakeMapRelations(
    const MapGraph& graph, const MapRelationsOptions& options) {
  const std::map<GraphId, GraphId> partners = LoopPartners(graph, options);
  std::vector<io::StampedRelation> relations;
  const GraphNode* start = nullptr;  // of the next relation along the path
  const GraphNode* last = nullptr;
  double path = 0., path_at_start = 0.;
  double path_at_loop = -std::numeric_limits<double>::infinity();
  for (const auto& entry : graph.nodes) {
    if (entry.first.trajectory_id != options.trajectory_id) continue;
    const GraphNode& node = entry.second;
    if (last != nullptr) path += Distance(*last, node);
    last = &node;
    if (start == nullptr) start = &node;
    if (path - path_at_start >= options.spacing) {
      relations.push_back(Relate(*start, node));
      start = &node;
      path_at_start = path;
    }
    const auto partner = partners.find(entry.first);
    if (partner != partners.end() && path - path_at_loop >= options.spacing) {
      relations.push_back(Relate(graph.nodes.at(partner->second), node));
      path_at_loop = path;
    }
  }
  return relations;
}

absl::StatusOr<std::vector<io::StampedRelation>> MakeRelationsIfSound(
    const MapGraph& graph, const std::string& name, const std::string& verdict,
    const MapRelationsOptions& options) {
  if (verdict != "sound") {
    return absl::FailedPreconditionError(absl::StrCat(
        name, ": relations are written for sound maps only, and this one is ",
        verdict));
  }
  std::vector<io::StampedRelation> relations = MakeMapRelations(graph, options);
  if (relations.empty()) {
    return absl::FailedPreconditionError(
        absl::StrCat(name, ": the path is shorter than ", options.spacing,
                     " m, so there are no relations"));
  }
  return relations;
}

}  // namespace evaluation
}  // namespace cartographer_ext
