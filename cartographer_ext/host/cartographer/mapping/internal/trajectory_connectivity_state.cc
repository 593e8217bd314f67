// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/trajectory_connectivity_state.h"

#include <algorithm>

namespace cartographer {
namespace mapping {
namespace {

std::pair<int, int> Sorted(const int a, const int b) {
  return std::make_pair(std::min(a, b), std::max(a, b));
}

}  // namespace

void TrajectoryConnectivityState::Add(const int trajectory_id) {
  components_.Add(trajectory_id);
}

void TrajectoryConnectivityState::Connect(const int trajectory_id_a,
                                          const int trajectory_id_b,
                                          const common::Time time) {
  if (TransitivelyConnected(trajectory_id_a, trajectory_id_b)) {
    common::Time& last =
        last_connection_times_[Sorted(trajectory_id_a, trajectory_id_b)];
    last = std::max(last, time);
  } else {
    for (const int a : components_.GetComponent(trajectory_id_a)) {
      for (const int b : components_.GetComponent(trajectory_id_b)) {
        last_connection_times_[Sorted(a, b)] = time;
      }
    }
  }
  components_.Connect(trajectory_id_a, trajectory_id_b);
}

bool TrajectoryConnectivityState::TransitivelyConnected(
    const int trajectory_id_a, const int trajectory_id_b) const {
  return components_.TransitivelyConnected(trajectory_id_a, trajectory_id_b);
}

std::vector<std::vector<int>> TrajectoryConnectivityState::Components() const {
  return components_.Components();
}

common::Time TrajectoryConnectivityState::LastConnectionTime(
    const int trajectory_id_a, const int trajectory_id_b) const {
  const auto it =
      last_connection_times_.find(Sorted(trajectory_id_a, trajectory_id_b));
  return it == last_connection_times_.end() ? common::Time() : it->second;
}

}  // namespace mapping
}  // namespace cartographer
