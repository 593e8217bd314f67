// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pbstream_map.h"

#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/map_painter.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::proto::PoseGraph;
using cartographer::transform::Rigid3d;
using cartographer::transform::ToRigid3;

template <typename IdProto>
GraphId ToNodeId(const IdProto& proto) {
  return {proto.trajectory_id(), proto.node_index()};
}

template <typename IdProto>
GraphId ToSubmapId(const IdProto& proto) {
  return {proto.trajectory_id(), proto.submap_index()};
}

struct GlobalPoses {
  std::map<GraphId, Rigid3d> nodes;
  std::map<GraphId, Rigid3d> submaps;
};

GlobalPoses CollectGlobalPoses(const PoseGraph& pose_graph) {
  GlobalPoses poses;
  for (const auto& trajectory : pose_graph.trajectory()) {
    for (const auto& node : trajectory.node()) {
      poses.nodes.emplace(
          GraphId{trajectory.trajectory_id(), node.node_index()},
          ToRigid3(node.pose()));
    }
    for (const auto& submap : trajectory.submap()) {
      poses.submaps.emplace(
          GraphId{trajectory.trajectory_id(), submap.submap_index()},
          ToRigid3(submap.pose()));
    }
  }
  return poses;
}

}  // namespace

std::vector<GraphConstraint> MakeConstraints(const PoseGraph& pose_graph) {
  std::vector<GraphConstraint> constraints;
  for (const auto& record : pose_graph.constraint()) {
    GraphConstraint constraint;
    constraint.submap_id = ToSubmapId(record.submap_id());
    constraint.node_id = ToNodeId(record.node_id());
    // Files already contain (submap <- tracking).
    constraint.relative_pose = ToPlanarPose(ToRigid3(record.relative_pose()));
    constraint.translation_weight = record.translation_weight();
    constraint.rotation_weight = record.rotation_weight();
    constraint.is_loop = record.tag() == PoseGraph::Constraint::INTER_SUBMAP;
    constraints.push_back(constraint);
  }
  return constraints;
}

MapGraph MakeMapGraph(const io::Pbstream& pbstream) {
  const GlobalPoses poses = CollectGlobalPoses(pbstream.pose_graph);
  MapGraph graph;
  for (const auto& record : pbstream.nodes) {
    const GraphId id = ToNodeId(record.node_id());
    const auto global = poses.nodes.find(id);
    if (global == poses.nodes.end()) continue;
    const auto& data = record.node_data();
    GraphNode node;
    node.time = FromHostTicks(data.timestamp());
    node.local_pose = ToPlanarPose(ToRigid3(data.local_pose()));
    node.global_pose = ToPlanarPose(global->second);
    node.global_tracking_pose = FromHostPose(global->second);
    graph.nodes[id] = node;
  }
  for (const auto& record : pbstream.submaps) {
    const GraphId id = ToSubmapId(record.submap_id());
    const auto global = poses.submaps.find(id);
    if (global == poses.submaps.end()) continue;
    GraphSubmap submap;
    submap.local_pose = ToPlanarPose(ToRigid3(record.submap_2d().local_pose()));
    submap.global_pose = ToPlanarPose(global->second);
    submap.finished = record.submap_2d().finished();
    submap.num_range_data = record.submap_2d().num_range_data();
    graph.submaps[id] = submap;
  }
  graph.constraints = MakeConstraints(pbstream.pose_graph);
  return graph;
}

absl::StatusOr<io::OccupancyMap> PaintPbstreamMap(const io::Pbstream& pbstream,
                                                  const double resolution) {
  const GlobalPoses poses = CollectGlobalPoses(pbstream.pose_graph);
  std::deque<SubmapGrid> grids;
  std::vector<PlacedGrid> placed;
  for (const auto& record : pbstream.submaps) {
    const auto global = poses.submaps.find(ToSubmapId(record.submap_id()));
    if (global == poses.submaps.end() || !record.submap_2d().has_grid()) {
      continue;
    }
    auto grid = SubmapGrid::Make(record.submap_2d().grid());
    if (!grid.ok()) return grid.status();
    grids.push_back(*std::move(grid));
    placed.push_back(
        {&grids.back(),
         ToPlanarPose(global->second) *
             ToPlanarPose(ToRigid3(record.submap_2d().local_pose()))
                 .Inverse()});
  }
  return PaintMap(placed, resolution);
}

}  // namespace evaluation
}  // namespace cartographer_ext
