// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/host_map.h"

#include <deque>
#include <utility>
#include <vector>

#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/map/map_painter.h"

namespace cartographer_ext {
namespace evaluation {

using cartographer::mapping::PoseGraphInterface;

MapGraph MakeMapGraph(const PoseGraphInterface& pose_graph) {
  MapGraph graph;
  for (const auto& entry : pose_graph.GetTrajectoryNodes()) {
    if (entry.data.constant_data == nullptr) continue;
    const auto& data = *entry.data.constant_data;
    GraphNode node;
    node.time = FromHostTime(data.time);
    node.local_pose = ToPlanarPose(data.local_pose);
    node.global_pose = ToPlanarPose(entry.data.global_pose);
    node.global_tracking_pose = FromHostPose(entry.data.global_pose);
    graph.nodes[{entry.id.trajectory_id, entry.id.node_index}] = node;
  }
  for (const auto& entry : pose_graph.GetAllSubmapData()) {
    if (entry.data.submap == nullptr) continue;
    GraphSubmap submap;
    submap.local_pose = ToPlanarPose(entry.data.submap->local_pose());
    submap.global_pose = ToPlanarPose(entry.data.pose);
    submap.finished = entry.data.submap->insertion_finished();
    submap.num_range_data = entry.data.submap->num_range_data();
    graph.submaps[{entry.id.trajectory_id, entry.id.submap_index}] = submap;
  }
  auto constraints = pose_graph.constraints();
  RemoveWithdrawnLoops(&constraints);
  for (const auto& entry : constraints) {
    GraphConstraint constraint;
    constraint.submap_id = {entry.submap_id.trajectory_id,
                            entry.submap_id.submap_index};
    constraint.node_id = {entry.node_id.trajectory_id,
                          entry.node_id.node_index};
    // What the pose graph hands out is (submap <- tracking), as in files.
    constraint.relative_pose = ToPlanarPose(entry.pose.zbar_ij);
    constraint.translation_weight = entry.pose.translation_weight;
    constraint.rotation_weight = entry.pose.rotation_weight;
    constraint.is_loop =
        entry.tag == PoseGraphInterface::Constraint::INTER_SUBMAP;
    graph.constraints.push_back(constraint);
  }
  return graph;
}

absl::StatusOr<io::OccupancyMap> PaintHostMap(
    const PoseGraphInterface& pose_graph, const double resolution) {
  std::deque<SubmapGrid> grids;
  std::vector<PlacedGrid> placed;
  for (const auto& entry : pose_graph.GetAllSubmapData()) {
    if (entry.data.submap == nullptr) continue;
    auto grid = SubmapGrid::Make(
        entry.data.submap->ToProto(true /* with grid */).submap_2d().grid());
    if (!grid.ok()) return grid.status();
    grids.push_back(*std::move(grid));
    placed.push_back(
        {&grids.back(),
         ToPlanarPose(entry.data.pose) *
             ToPlanarPose(entry.data.submap->local_pose()).Inverse()});
  }
  return PaintMap(placed, resolution);
}

}  // namespace evaluation
}  // namespace cartographer_ext
