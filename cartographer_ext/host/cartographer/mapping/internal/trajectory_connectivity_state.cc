// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/trajectory_connectivity_state.h"

#include <algorithm>

namespace cartographer {
namespace mapping {

void TrajectoryConnectivityState::Add(const int trajectory_id) {
  GroupOf(trajectory_id);
}

const TrajectoryConnectivityState::Group& TrajectoryConnectivityState::GroupOf(
    const int trajectory_id) {
  Group& group = groups_[trajectory_id];
  if (group == nullptr) {
    group = std::make_shared<std::set<int>>();
    group->insert(trajectory_id);
  }
  return group;
}

void TrajectoryConnectivityState::Connect(const int trajectory_id_a,
                                          const int trajectory_id_b,
                                          const common::Time time) {
  const Group joined = GroupOf(trajectory_id_a);
  const Group absorbed = GroupOf(trajectory_id_b);
  if (joined == absorbed) {
    common::Time& last =
        last_connection_times_[std::minmax({trajectory_id_a, trajectory_id_b})];
    last = std::max(last, time);
    return;
  }
  for (const int b : *absorbed) {
    for (const int a : *joined) {
      last_connection_times_[std::minmax({a, b})] = time;
    }
  }
  for (const int b : *absorbed) {
    groups_[b] = joined;
    joined->insert(b);
  }
}

bool TrajectoryConnectivityState::TransitivelyConnected(
    const int trajectory_id_a, const int trajectory_id_b) const {
  if (trajectory_id_a == trajectory_id_b) {
    return true;
  }
  const auto group_a = groups_.find(trajectory_id_a);
  return group_a != groups_.end() && group_a->second->count(trajectory_id_b);
}

std::vector<std::vector<int>> TrajectoryConnectivityState::Components() const {
  std::vector<std::vector<int>> result;
  for (const auto& id_group : groups_) {
    const std::set<int>& members = *id_group.second;
    if (id_group.first == *members.begin()) {
      result.emplace_back(members.begin(), members.end());
    }
  }
  return result;
}

common::Time TrajectoryConnectivityState::LastConnectionTime(
    const int trajectory_id_a, const int trajectory_id_b) const {
  const auto last = last_connection_times_.find(
      std::minmax({trajectory_id_a, trajectory_id_b}));
  return last == last_connection_times_.end() ? common::FromUniversal(0)
                                              : last->second;
}

}  // namespace mapping
}  // namespace cartographer
