// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/inter_trajectory_loops.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "Eigen/Core"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Loops remembered of a run in a map; the oldest are forgotten first.
constexpr size_t kMaxLoops = 20000;

}  // namespace

void InterTrajectoryLoops::Add(const Constraint& loop) {
  const int trajectory_id = loop.node_id.trajectory_id;
  const int map_trajectory_id = loop.submap_id.trajectory_id;
  if (trajectory_id == map_trajectory_id) return;
  Loops& loops = loops_[std::make_pair(trajectory_id, map_trajectory_id)];
  loops.emplace_back(loop.node_id.node_index, BitsOf(loop.pose));
  if (loops.size() > kMaxLoops) loops.pop_front();
}

void InterTrajectoryLoops::Withdraw(const int trajectory_id,
                                    const int map_trajectory_id,
                                    const int last_node) {
  Loops& loops = loops_[std::make_pair(trajectory_id, map_trajectory_id)];
  const auto withdrawn = std::stable_partition(
      loops.begin(), loops.end(), [last_node](const Loops::value_type& loop) {
        return loop.first > last_node;
      });
  for (auto it = withdrawn; it != loops.end(); ++it) {
    RememberFullInformation(it->second, Eigen::Matrix3d::Zero());
  }
  loops.erase(withdrawn, loops.end());
}

void InterTrajectoryLoops::DeleteTrajectory(const int trajectory_id) {
  for (auto it = loops_.begin(); it != loops_.end();) {
    const bool is_of_it =
        it->first.first == trajectory_id || it->first.second == trajectory_id;
    it = is_of_it ? loops_.erase(it) : std::next(it);
  }
}

}  // namespace loop_closure
}  // namespace cartographer_ext
