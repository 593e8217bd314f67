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

// How well a scan fixes its pose in a grid: J^T J of the occupied-space
// residuals (paper G eq. 14 to 17) at `pose` (frame of the grid <- cloud),
// divided by the mean squared residual, as information about (x, y, theta) of
// (submap <- cloud); metres, radians. `submap_pose` is (frame of the grid <-
// submap). Weak along a corridor, strong across it. Zero for a TSDF, an empty
// cloud, and where the scan does not touch the map.
Eigen::Matrix3d MatchInformation(const cartographer::mapping::Grid2D& grid,
                                 const cartographer::sensor::PointCloud& cloud,
                                 const Pose2& pose, const Pose2& submap_pose);

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_MATCH_INFORMATION_H_
