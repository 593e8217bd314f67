// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Global poses at every scan. The pose graph holds nodes only, and the motion
// filter makes far fewer nodes than there are scans; interpolating between
// nodes in time would assume constant speed. But local SLAM has matched every
// scan. Between two nodes its path is right except for the correction by the
// optimisation, so the pose of each scan is computed once from the previous and
// once from the next node, each at its optimised pose:
//
//   from before   global(a) * local(a)^-1 * local(scan)
//   from after    global(b) * local(b)^-1 * local(scan)
//
// and the two are interpolated in time, which is exact at both nodes and
// continuous.
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
// the last node use that node only. Empty without nodes.
std::vector<StampedPose> GlobalScanPoses(
    const std::vector<StampedPose>& local_scans,
    const std::vector<NodePoses>& nodes);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SCAN_TRAJECTORY_H_
