// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_optimization.h"

#include <algorithm>
#include <map>
#include <set>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/full_information.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/pose_graph_export.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;
using optimization::PoseGraphEdge;

// Of loops in stock configurations.
constexpr double kStockLoopWeight = 1.1e4;

double WeightScale(const MapGraph& map, const double loop_sigma) {
  std::vector<double> weights;
  for (const GraphConstraint& constraint : map.constraints) {
    if (constraint.is_loop && constraint.translation_weight > 0.) {
      weights.push_back(constraint.translation_weight);
    }
  }
  double weight = kStockLoopWeight;
  if (!weights.empty()) {
    std::nth_element(weights.begin(), weights.begin() + weights.size() / 2,
                     weights.end());
    weight = weights[weights.size() / 2];
  }
  return 1. / (weight * loop_sigma);
}

// before <- after, in the plane, applied to a pose in space.
Rigid3d Moved(const Rigid3d& pose, const Pose2& planar) {
  const Pose2 old = ToPlanarPose(pose);
  const Pose2 step = planar * old.Inverse();
  const Rigid3d moved = cartographer::transform::Embed3D(Rigid2d(
                            Eigen::Vector2d(step.x, step.y), step.theta)) *
                        pose;
  return moved;
}

}  // namespace

absl::StatusOr<MapPoseGraph> MakeMapPoseGraph(
    const MapGraph& map, const MapOptimizationOptions& options) {
  if (!(options.loop_sigma > 0.)) {
    return absl::InvalidArgumentError("the sigma of loops must be positive");
  }
  MapPoseGraph result;
  std::map<GraphId, int> vertex_of_submap, vertex_of_node;
  const auto add_submap = [&](const GraphId& id) {
    if (!vertex_of_submap.emplace(id, result.id_of_vertex.size()).second) {
      return;
    }
    result.id_of_vertex.push_back(id);
    result.vertex_is_submap.push_back(true);
    result.graph.ids.push_back(SubmapVertexId(id));
    result.graph.poses.push_back(map.submaps.at(id).global_pose);
  };
  // Submaps by the first node inserted in them.
  std::map<GraphId, std::vector<GraphId>> submaps_of_node;
  for (const auto& inserted : map.InsertedNodes()) {
    if (map.submaps.count(inserted.first) != 0 && !inserted.second.empty()) {
      submaps_of_node[inserted.second.front()].push_back(inserted.first);
    }
  }
  if (!map.submaps.empty()) add_submap(map.submaps.begin()->first);
  for (const auto& entry : map.nodes) {
    vertex_of_node[entry.first] = result.id_of_vertex.size();
    result.id_of_vertex.push_back(entry.first);
    result.vertex_is_submap.push_back(false);
    result.graph.ids.push_back(NodeVertexId(entry.first));
    result.graph.poses.push_back(entry.second.global_pose);
    for (const GraphId& submap : submaps_of_node[entry.first]) {
      add_submap(submap);
    }
  }
  // A submap without nodes hangs in the air unless loops hold it; such a map
  // fails the check below with the submap's name.
  for (const auto& entry : map.submaps) add_submap(entry.first);

  const double scale = WeightScale(map, options.loop_sigma);
  for (size_t i = 0; i != map.constraints.size(); ++i) {
    const GraphConstraint& constraint = map.constraints[i];
    const auto submap = vertex_of_submap.find(constraint.submap_id);
    const auto node = vertex_of_node.find(constraint.node_id);
    if (submap == vertex_of_submap.end() || node == vertex_of_node.end() ||
        !(constraint.translation_weight > 0.) ||
        !(constraint.rotation_weight > 0.)) {
      continue;
    }
    PoseGraphEdge edge;
    edge.from = submap->second;
    edge.to = node->second;
    edge.measurement = constraint.relative_pose;
    edge.information =
        InformationOfWeights(scale * constraint.translation_weight,
                             scale * constraint.rotation_weight);
    edge.is_loop = constraint.is_loop;
    result.graph.edges.push_back(edge);
    result.constraint_of_edge.push_back(i);
  }
  for (auto next = map.nodes.begin(); next != map.nodes.end();) {
    const auto first = next++;
    if (next == map.nodes.end() ||
        next->first.trajectory_id != first->first.trajectory_id ||
        next->first.index != first->first.index + 1) {
      continue;
    }
    PoseGraphEdge edge;
    edge.from = vertex_of_node.at(first->first);
    edge.to = vertex_of_node.at(next->first);
    edge.measurement =
        Between(first->second.local_pose, next->second.local_pose);
    edge.information =
        InformationOfWeights(scale * options.local_slam_translation_weight,
                             scale * options.local_slam_rotation_weight);
    result.graph.edges.push_back(edge);
    result.constraint_of_edge.push_back(-1);
  }
  const absl::Status status = optimization::ValidatePoseGraph(result.graph);
  if (!status.ok()) return status;
  return result;
}

void StorePoses(const MapPoseGraph& graph, const std::vector<Pose2>& poses,
                io::Pbstream* const pbstream) {
  std::map<GraphId, Pose2> submaps, nodes;
  for (size_t i = 0; i != graph.id_of_vertex.size(); ++i) {
    (graph.vertex_is_submap[i] ? submaps : nodes)[graph.id_of_vertex[i]] =
        poses[i];
  }
  for (auto& trajectory : *pbstream->pose_graph.mutable_trajectory()) {
    for (auto& node : *trajectory.mutable_node()) {
      const auto pose =
          nodes.find({trajectory.trajectory_id(), node.node_index()});
      if (pose == nodes.end()) continue;
      *node.mutable_pose() = cartographer::transform::ToProto(
          Moved(cartographer::transform::ToRigid3(node.pose()), pose->second));
    }
    for (auto& submap : *trajectory.mutable_submap()) {
      const auto pose =
          submaps.find({trajectory.trajectory_id(), submap.submap_index()});
      if (pose == submaps.end()) continue;
      *submap.mutable_pose() = cartographer::transform::ToProto(Moved(
          cartographer::transform::ToRigid3(submap.pose()), pose->second));
    }
  }
}

void DropConstraints(const std::vector<int>& indices,
                     io::Pbstream* const pbstream) {
  const std::set<int> dropped(indices.begin(), indices.end());
  auto* const constraints = pbstream->pose_graph.mutable_constraint();
  int kept = 0;
  for (int i = 0; i != constraints->size(); ++i) {
    if (dropped.count(i) != 0) continue;
    if (kept != i) constraints->SwapElements(kept, i);
    ++kept;
  }
  constraints->DeleteSubrange(kept, constraints->size() - kept);
}

absl::StatusOr<std::vector<int>> FindLoops(const MapGraph& map,
                                           const std::string& names) {
  std::vector<int> result;
  for (const std::string& name : std::vector<std::string>(
           absl::StrSplit(names, absl::ByAnyChar(", \n"), absl::SkipEmpty()))) {
    const std::vector<std::string> parts = absl::StrSplit(name, ':');
    int numbers[4];
    bool ok = parts.size() == 4;
    for (size_t i = 0; ok && i != 4; ++i) {
      ok = absl::SimpleAtoi(parts[i], &numbers[i]);
    }
    if (!ok) {
      return absl::InvalidArgumentError(
          absl::StrCat("'", name,
                       "' is not submap_trajectory:submap:node_trajectory:"
                       "node"));
    }
    const GraphId submap{numbers[0], numbers[1]}, node{numbers[2], numbers[3]};
    const size_t before = result.size();
    for (size_t i = 0; i != map.constraints.size(); ++i) {
      const GraphConstraint& constraint = map.constraints[i];
      if (constraint.is_loop && constraint.submap_id == submap &&
          constraint.node_id == node) {
        result.push_back(i);
      }
    }
    if (result.size() == before) {
      return absl::InvalidArgumentError(
          absl::StrCat("the map has no loop between submap ", ToString(submap),
                       " and node ", ToString(node)));
    }
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
