// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/node_history.h"

#include <algorithm>
#include <utility>

#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {

NodeHistory::NodeHistory(const int max_nodes)
    : max_nodes_(static_cast<size_t>(std::max(max_nodes, 1))) {
  CHECK_GT(max_nodes, 0);
}

bool NodeHistory::Add(const int trajectory_id, HistoryNode node) {
  std::map<int, HistoryNode>& nodes = trajectories_[trajectory_id];
  const int index = node.node_index;
  if (nodes.count(index) != 0) return false;
  if (nodes.size() == max_nodes_) {
    if (index < nodes.begin()->first) return false;
    nodes.erase(nodes.begin());
  }
  nodes.emplace(index, std::move(node));
  return true;
}

bool NodeHistory::Contains(const int trajectory_id,
                           const int node_index) const {
  return Find(trajectory_id, node_index) != nullptr;
}

const HistoryNode* NodeHistory::Find(const int trajectory_id,
                                     const int node_index) const {
  const auto nodes = trajectories_.find(trajectory_id);
  if (nodes == trajectories_.end()) return nullptr;
  const auto node = nodes->second.find(node_index);
  return node == nodes->second.end() ? nullptr : &node->second;
}

int NodeHistory::size(const int trajectory_id) const {
  const auto nodes = trajectories_.find(trajectory_id);
  return nodes == trajectories_.end() ? 0
                                      : static_cast<int>(nodes->second.size());
}

std::vector<const HistoryNode*> NodeHistory::Sequence(
    const int trajectory_id, const int node_index, const int count,
    const double spacing, const int max_scan) const {
  std::vector<const HistoryNode*> sequence;
  const auto nodes = trajectories_.find(trajectory_id);
  if (count <= 0 || nodes == trajectories_.end()) return sequence;
  auto it = nodes->second.find(node_index);
  if (it == nodes->second.end()) return sequence;
  sequence.push_back(&it->second);
  double travelled = 0.;
  for (int scanned = 0;
       scanned < max_scan && static_cast<int>(sequence.size()) < count &&
       it != nodes->second.begin();
       ++scanned) {
    const Pose2 newer = it->second.local_pose;
    --it;
    travelled +=
        (newer.translation() - it->second.local_pose.translation()).norm();
    if (travelled >= spacing) {
      sequence.push_back(&it->second);
      travelled = 0.;
    }
  }
  std::reverse(sequence.begin(), sequence.end());
  return sequence;
}

void NodeHistory::DeleteTrajectory(const int trajectory_id) {
  trajectories_.erase(trajectory_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
