// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/online_poses.h"

#include <algorithm>
#include <cstddef>

namespace cartographer_ext {
namespace evaluation {

void OnlinePoses::Start(const Eigen::Isometry3d& map_from_local) {
  absl::MutexLock lock(&mutex_);
  start_ = map_from_local;
}

void OnlinePoses::AddNode(const int node_index, const io::TimeNs time) {
  absl::MutexLock lock(&mutex_);
  node_times_[node_index] = time;
}

void OnlinePoses::AddOptimization(const int node_index,
                                  const Eigen::Isometry3d& map_from_local) {
  absl::MutexLock lock(&mutex_);
  optimizations_.emplace_back(node_index, map_from_local);
}

std::vector<StampedPose> OnlinePoses::At(
    const std::vector<StampedPose>& local_scans) const {
  absl::MutexLock lock(&mutex_);
  // In order of time. If there are two optimisations for one node, the later
  // one applies.
  std::vector<std::pair<io::TimeNs, Eigen::Isometry3d>> changes;
  for (const auto& optimization : optimizations_) {
    const auto node = node_times_.find(optimization.first);
    if (node != node_times_.end()) {
      changes.emplace_back(node->second, optimization.second);
    }
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const std::pair<io::TimeNs, Eigen::Isometry3d>& a,
                      const std::pair<io::TimeNs, Eigen::Isometry3d>& b) {
                     return a.first < b.first;
                   });
  std::vector<StampedPose> poses;
  poses.reserve(local_scans.size());
  Eigen::Isometry3d map_from_local = start_;
  size_t next = 0;
  for (const StampedPose& scan : local_scans) {
    for (; next < changes.size() && changes[next].first < scan.time; ++next) {
      map_from_local = changes[next].second;
    }
    poses.push_back({scan.time, map_from_local * scan.pose});
  }
  return poses;
}

void OnlinePoses::SetLocalized(const int node_index) {
  const absl::MutexLock lock(&mutex_);
  if (!localized_node_.has_value()) localized_node_ = node_index;
}

bool OnlinePoses::is_localized() const {
  const absl::MutexLock lock(&mutex_);
  return localized_node_.has_value();
}

absl::optional<StampedPose> OnlinePoses::LocalizedAt(
    const std::vector<StampedPose>& local_scans) const {
  absl::optional<io::TimeNs> time;
  {
    const absl::MutexLock lock(&mutex_);
    if (!localized_node_.has_value()) return absl::nullopt;
    const auto node = node_times_.find(*localized_node_);
    if (node == node_times_.end()) return absl::nullopt;
    time = node->second;
  }
  // The result of the optimisation applies to scans after its node.
  for (const StampedPose& pose : At(local_scans)) {
    if (pose.time > *time) return pose;
  }
  return absl::nullopt;
}

}  // namespace evaluation
}  // namespace cartographer_ext
