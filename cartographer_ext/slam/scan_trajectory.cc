// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/scan_trajectory.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

Eigen::Isometry3d SeenFrom(const NodePoses& node,
                           const Eigen::Isometry3d& local_scan) {
  return node.global_pose * node.local_pose.inverse() * local_scan;
}

Eigen::Isometry3d Blend(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b,
                        const double ratio) {
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(a.linear())
          .slerp(ratio, Eigen::Quaterniond(b.linear()));
  const Eigen::Vector3d translation =
      (1. - ratio) * a.translation() + ratio * b.translation();
  return Eigen::Translation3d(translation) * rotation.normalized();
}

}  // namespace

std::vector<StampedPose> GlobalScanPoses(
    const std::vector<StampedPose>& local_scans,
    const std::vector<NodePoses>& nodes) {
  std::vector<StampedPose> result;
  if (nodes.empty()) return result;
  result.reserve(local_scans.size());
  size_t next = 0;  // first node at or after the scan
  for (const StampedPose& scan : local_scans) {
    while (next < nodes.size() && nodes[next].time < scan.time) ++next;
    StampedPose global;
    global.time = scan.time;
    if (next == 0) {
      global.pose = SeenFrom(nodes.front(), scan.pose);
    } else if (next == nodes.size()) {
      global.pose = SeenFrom(nodes.back(), scan.pose);
    } else {
      const NodePoses& before = nodes[next - 1];
      const NodePoses& after = nodes[next];
      const double ratio = static_cast<double>(scan.time - before.time) /
                           static_cast<double>(after.time - before.time);
      global.pose =
          Blend(SeenFrom(before, scan.pose), SeenFrom(after, scan.pose), ratio);
    }
    result.push_back(global);
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
