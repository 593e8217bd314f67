// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_optimization.h"

#include <map>
#include <set>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/loop_id.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/pose_graph_export.h"
#include "cartographer_ext/optimization/graph/slam_pose_graph.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;

LoopId ToLoopId(const GraphConstraint& constraint) {
  LoopId id;
  id.submap_trajectory = constraint.submap_id.trajectory_id;
  id.submap_index = constraint.submap_id.index;
  id.node_trajectory = constraint.node_id.trajectory_id;
  id.node_index = constraint.node_id.index;
  return id;
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
  optimization::SlamGraph slam;
  std::vector<GraphId> nodes, submaps;
  for (const auto& entry : map.nodes) {
    optimization::SlamNode node;
    node.id = {entry.first.trajectory_id, entry.first.index};
    node.local_pose = entry.second.local_pose;
    node.global_pose = entry.second.global_pose;
    slam.nodes.push_back(node);
    nodes.push_back(entry.first);
  }
  for (const auto& entry : map.submaps) {
    optimization::SlamSubmap submap;
    submap.id = {entry.first.trajectory_id, entry.first.index};
    submap.global_pose = entry.second.global_pose;
    slam.submaps.push_back(submap);
    submaps.push_back(entry.first);
  }
  for (const GraphConstraint& constraint : map.constraints) {
    optimization::SlamConstraint edge;
    edge.id = ToLoopId(constraint);
    edge.relative_pose = constraint.relative_pose;
    edge.translation_weight = constraint.translation_weight;
    edge.rotation_weight = constraint.rotation_weight;
    edge.is_loop = constraint.is_loop;
    slam.constraints.push_back(edge);
  }
  optimization::SlamPoseGraphOptions graph_options;
  graph_options.loop_sigma = options.loop_sigma;
  graph_options.local_slam_translation_weight =
      options.local_slam_translation_weight;
  graph_options.local_slam_rotation_weight = options.local_slam_rotation_weight;
  optimization::SlamPoseGraph made =
      optimization::MakeSlamPoseGraph(slam, graph_options);
  MapPoseGraph result;
  result.graph = std::move(made.graph);
  result.constraint_of_edge = std::move(made.constraint_of_edge);
  for (size_t i = 0; i != made.vertices.size(); ++i) {
    const auto& vertex = made.vertices[i];
    const GraphId& id = (vertex.is_submap ? submaps : nodes)[vertex.index];
    result.id_of_vertex.push_back(id);
    result.vertex_is_submap.push_back(vertex.is_submap);
    result.graph.ids[i] =
        vertex.is_submap ? SubmapVertexId(id) : NodeVertexId(id);
  }
  // A submap without nodes is not connected unless a loop connects it; the
  // check names it.
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

void DropConstraints(
    const std::vector<int>& indices,
    cartographer::mapping::proto::PoseGraph* const pose_graph) {
  const std::set<int> dropped(indices.begin(), indices.end());
  auto* const constraints = pose_graph->mutable_constraint();
  int kept = 0;
  for (int i = 0; i != constraints->size(); ++i) {
    if (dropped.count(i) != 0) continue;
    if (kept != i) constraints->SwapElements(kept, i);
    ++kept;
  }
  constraints->DeleteSubrange(kept, constraints->size() - kept);
}

void DropConstraints(const std::vector<int>& indices,
                     io::Pbstream* const pbstream) {
  DropConstraints(indices, &pbstream->pose_graph);
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
      return absl::NotFoundError(
          absl::StrCat("the map has no loop between submap ", ToString(submap),
                       " and node ", ToString(node)));
    }
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
