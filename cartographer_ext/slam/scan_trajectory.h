// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Global poses at every scan. The pose graph holds nodes only, and the motion
// filter makes far fewer nodes than there are scans; interpolating between
// nodes in time supposes a constant speed that no robot has. Local SLAM however
// did match every scan. Between two nodes its path is right but for the
// correction that the optimisation gave them, so each scan is seen once from
// the node before and once from the node after, each at its optimised pose:
//
//   from before   global(a) * local(a)^-1 * local(scan)
//   from after    global(b) * local(b)^-1 * local(scan)
//
// and the two are blended in proportion to the time that has passed, which
// meets both nodes exactly and leaves no jump.
#ifndef CARTOGRAPHER_EXT_SLAM_SCAN_TRAJECTORY_H_
#define CARTOGRAPHER_EXT_SLAM_SCAN_TRAJECTORY_H_

#include <vector>

#include "Eigen/Geometry"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

struct NodePoses {
  io::TimeNs time = 0;
  Eigen::Isometry3d local_pose = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d global_pose = Eigen::Isometry3d::Identity();
};

// `local_scans` and `nodes` in order of time. Scans before the first or after
// the last node follow that node alone. Empty when there are no nodes.
std::vector<StampedPose> GlobalScanPoses(
    const std::vector<StampedPose>& local_scans,
    const std::vector<NodePoses>& nodes);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SCAN_TRAJECTORY_H_
