// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_graph.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace evaluation {

std::string ToString(const GraphId& id) {
  return absl::StrCat("(", id.trajectory_id, ", ", id.index, ")");
}

std::string LoopName(const GraphId& submap_id, const GraphId& node_id) {
  return absl::StrCat(submap_id.trajectory_id, ":", submap_id.index, ":",
                      node_id.trajectory_id, ":", node_id.index);
}

int64_t MapGraph::num_loops() const {
  return std::count_if(
      constraints.begin(), constraints.end(),
      [](const GraphConstraint& constraint) { return constraint.is_loop; });
}

Trajectory MapGraph::GlobalTrajectory(const int trajectory_id) const {
  std::vector<StampedPose> poses;
  for (const auto& entry : nodes) {
    if (entry.first.trajectory_id != trajectory_id) continue;
    poses.push_back({entry.second.time, entry.second.global_tracking_pose});
  }
  return Trajectory(std::move(poses));
}

Trajectory MapGraph::GlobalTrajectory() const {
  std::vector<StampedPose> poses;
  for (const auto& entry : nodes) {
    poses.push_back({entry.second.time, entry.second.global_tracking_pose});
  }
  return Trajectory(std::move(poses));
}

Trajectory MapGraph::LocalTrajectory(const int trajectory_id) const {
  std::vector<StampedPose> poses;
  for (const auto& entry : nodes) {
    if (entry.first.trajectory_id != trajectory_id) continue;
    poses.push_back({entry.second.time, ToIsometry(entry.second.local_pose)});
  }
  return Trajectory(std::move(poses));
}

std::set<int> MapGraph::TiedTrajectories() const {
  std::set<int> trajectories;
  for (const GraphConstraint& constraint : constraints) {
    if (submaps.count(constraint.submap_id) > 0) {
      trajectories.insert(constraint.node_id.trajectory_id);
    }
  }
  return trajectories;
}

std::map<GraphId, std::vector<GraphId>> MapGraph::InsertedNodes() const {
  std::map<GraphId, std::vector<GraphId>> inserted;
  for (const GraphConstraint& constraint : constraints) {
    if (constraint.is_loop || nodes.count(constraint.node_id) == 0) continue;
    inserted[constraint.submap_id].push_back(constraint.node_id);
  }
  for (auto& entry : inserted) {
    std::sort(entry.second.begin(), entry.second.end());
  }
  return inserted;
}

Pose2 Residual(const GraphConstraint& constraint, const GraphSubmap& submap,
               const GraphNode& node) {
  return Between(constraint.relative_pose,
                 Between(submap.global_pose, node.global_pose));
}

}  // namespace evaluation
}  // namespace cartographer_ext
