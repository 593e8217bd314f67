// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/store_graph.h"

#include <iterator>
#include <map>
#include <string>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/pbstream_optimization.h"

namespace cartographer_ext {
namespace repair {
namespace {

using cartographer::mapping::proto::PoseGraph;
using cartographer::transform::Rigid3d;
using cartographer::transform::ToProto;
using cartographer::transform::ToRigid3;
using evaluation::GraphId;

// Height, roll and pitch of `pose` with another place and heading.
Rigid3d Moved(const Rigid3d& pose, const Pose2& planar) {
  return evaluation::ToHostPose(planar *
                                evaluation::ToPlanarPose(pose).Inverse()) *
         pose;
}

// The last node of the trajectory at or before the stamp of the last sight.
std::map<std::string, GraphId> LastSights(const io::Pbstream& pbstream) {
  std::map<int, std::map<int64_t, int>> nodes;
  for (const auto& node : pbstream.nodes) {
    nodes[node.node_id().trajectory_id()][node.node_data().timestamp()] =
        node.node_id().node_index();
  }
  std::map<std::string, GraphId> sights;
  for (const auto& record : pbstream.landmark_data) {
    const auto trajectory = nodes.find(record.trajectory_id());
    if (trajectory == nodes.end() || trajectory->second.empty()) continue;
    auto node =
        trajectory->second.upper_bound(record.landmark_data().timestamp());
    if (node != trajectory->second.begin()) node = std::prev(node);
    for (const auto& seen : record.landmark_data().landmark_observations()) {
      sights[seen.id()] = {record.trajectory_id(), node->second};
    }
  }
  return sights;
}

void MoveLandmarks(const std::map<GraphId, Rigid3d>& motions,
                   io::Pbstream* const pbstream) {
  if (pbstream->pose_graph.landmark_poses_size() == 0) return;
  const std::map<std::string, GraphId> sights = LastSights(*pbstream);
  for (auto& landmark : *pbstream->pose_graph.mutable_landmark_poses()) {
    const auto sight = sights.find(landmark.landmark_id());
    if (sight == sights.end()) continue;
    const auto motion = motions.find(sight->second);
    if (motion == motions.end()) continue;
    *landmark.mutable_global_pose() =
        ToProto(motion->second * ToRigid3(landmark.global_pose()));
  }
}

}  // namespace

void StoreGraph(const evaluation::MapGraph& graph,
                io::Pbstream* const pbstream) {
  std::map<GraphId, Rigid3d> motions, tilts;
  for (auto& trajectory : *pbstream->pose_graph.mutable_trajectory()) {
    const int id = trajectory.trajectory_id();
    for (auto& node : *trajectory.mutable_node()) {
      const auto found = graph.nodes.find({id, node.node_index()});
      if (found == graph.nodes.end()) continue;
      const Rigid3d before = ToRigid3(node.pose());
      const Rigid3d after = Moved(before, found->second.global_pose);
      motions[found->first] = after * before.inverse();
      tilts[found->first] = after;
      *node.mutable_pose() = ToProto(after);
    }
    for (auto& submap : *trajectory.mutable_submap()) {
      const auto found = graph.submaps.find({id, submap.submap_index()});
      if (found == graph.submaps.end()) continue;
      *submap.mutable_pose() =
          ToProto(Moved(ToRigid3(submap.pose()), found->second.global_pose));
    }
  }
  MoveLandmarks(motions, pbstream);
  std::vector<int> loops;
  for (int i = 0; i < pbstream->pose_graph.constraint_size(); ++i) {
    if (pbstream->pose_graph.constraint(i).tag() ==
        PoseGraph::Constraint::INTER_SUBMAP) {
      loops.push_back(i);
    }
  }
  evaluation::DropConstraints(loops, pbstream);
  for (const auto& loop : graph.constraints) {
    if (!loop.is_loop || loop.switched_off) continue;
    const auto tilt = tilts.find(loop.node_id);
    if (tilt == tilts.end() || graph.submaps.count(loop.submap_id) == 0) {
      continue;
    }
    auto* const constraint = pbstream->pose_graph.add_constraint();
    constraint->mutable_submap_id()->set_trajectory_id(
        loop.submap_id.trajectory_id);
    constraint->mutable_submap_id()->set_submap_index(loop.submap_id.index);
    constraint->mutable_node_id()->set_trajectory_id(
        loop.node_id.trajectory_id);
    constraint->mutable_node_id()->set_node_index(loop.node_id.index);
    *constraint->mutable_relative_pose() =
        ToProto(Moved(tilt->second, loop.relative_pose));
    constraint->set_translation_weight(loop.translation_weight);
    constraint->set_rotation_weight(loop.rotation_weight);
    constraint->set_tag(PoseGraph::Constraint::INTER_SUBMAP);
  }
}

void MoveMap(const Pose2& new_from_old, io::Pbstream* const pbstream) {
  const Rigid3d motion = evaluation::ToHostPose(new_from_old);
  for (auto& trajectory : *pbstream->pose_graph.mutable_trajectory()) {
    for (auto& node : *trajectory.mutable_node()) {
      *node.mutable_pose() = ToProto(motion * ToRigid3(node.pose()));
    }
    for (auto& submap : *trajectory.mutable_submap()) {
      *submap.mutable_pose() = ToProto(motion * ToRigid3(submap.pose()));
    }
  }
  for (auto& landmark : *pbstream->pose_graph.mutable_landmark_poses()) {
    *landmark.mutable_global_pose() =
        ToProto(motion * ToRigid3(landmark.global_pose()));
  }
}

}  // namespace repair
}  // namespace cartographer_ext
