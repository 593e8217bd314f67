// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The pose of each scan as published by the running system, which differs from
// its pose in the finished map:
//
//   (map <- robot) = (map <- local) * (local <- robot),
//
// with (map <- local) after the last optimisation before the scan. Every
// optimisation belongs to the node that triggered it: later scans use its
// result, as with a back end without delay. This does not depend on the replay
// speed or on threads.
#ifndef CARTOGRAPHER_EXT_SLAM_ONLINE_POSES_H_
#define CARTOGRAPHER_EXT_SLAM_ONLINE_POSES_H_

#include <map>
#include <utility>
#include <vector>

#include "Eigen/Geometry"
#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/types/optional.h"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

// Scans and optimisations may be added by different threads.
class OnlinePoses {
 public:
  OnlinePoses() = default;
  OnlinePoses(const OnlinePoses&) = delete;
  OnlinePoses& operator=(const OnlinePoses&) = delete;

  // (map <- local) until the first optimisation; identity unless set.
  void Start(const Eigen::Isometry3d& map_from_local)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Records that the scan at `time` became this node. In any order.
  void AddNode(int node_index, io::TimeNs time) ABSL_LOCKS_EXCLUDED(mutex_);
  // Adds the result of an optimisation up to and including this node.
  void AddOptimization(int node_index, const Eigen::Isometry3d& map_from_local)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Records that an optimisation up to and including this node has constrained
  // it to a loaded map. The first call counts.
  void SetLocalized(int node_index) ABSL_LOCKS_EXCLUDED(mutex_);
  bool is_localized() const ABSL_LOCKS_EXCLUDED(mutex_);
  // (map <- robot) at the first scan from that node on; none if there is none.
  absl::optional<StampedPose> LocalizedAt(
      const std::vector<StampedPose>& local_scans) const
      ABSL_LOCKS_EXCLUDED(mutex_);

  // (map <- robot) at each of the scans, which are (local <- robot) in order of
  // time. An optimisation of a node that was never added has no effect.
  std::vector<StampedPose> At(const std::vector<StampedPose>& local_scans) const
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  Eigen::Isometry3d start_ ABSL_GUARDED_BY(mutex_) =
      Eigen::Isometry3d::Identity();
  absl::optional<int> localized_node_ ABSL_GUARDED_BY(mutex_);
  std::map<int, io::TimeNs> node_times_ ABSL_GUARDED_BY(mutex_);
  std::vector<std::pair<int, Eigen::Isometry3d>> optimizations_
      ABSL_GUARDED_BY(mutex_);
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_ONLINE_POSES_H_
