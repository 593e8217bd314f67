// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_MATCH_INFORMATION_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_MATCH_INFORMATION_H_

#include "Eigen/Core"
#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace loop_closure {

// Information about (x, y, theta) of (submap <- cloud), metres and radians, of
// a scan matched at `pose` (frame of the grid <- cloud), by the estimator of
// local SLAM (uncertainty/match_information.h): zero along a corridor, large
// across it. `submap_pose` is (frame of the grid <- submap). Zero for a TSDF,
// an empty cloud, and if the scan does not overlap the map.
Eigen::Matrix3d MatchInformation(const cartographer::mapping::Grid2D& grid,
                                 const cartographer::sensor::PointCloud& cloud,
                                 const Pose2& pose, const Pose2& submap_pose);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_MATCH_INFORMATION_H_
