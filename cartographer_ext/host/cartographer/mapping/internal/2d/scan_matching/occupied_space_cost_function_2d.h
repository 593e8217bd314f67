// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_OCCUPIED_SPACE_COST_FUNCTION_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_OCCUPIED_SPACE_COST_FUNCTION_2D_H_

#include "cartographer/mapping/2d/grid_2d.h"
#include "cartographer/sensor/point_cloud.h"
#include "ceres/ceres.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// One residual per point of the cloud for a pose (x, y, theta):
//   scaling_factor * (correspondence cost at the transformed point),
// interpolated bicubically between cell centres; 0.9 outside the grid. Only x
// and y of the points are used. Cloud and grid must outlive the cost function.
ceres::CostFunction* CreateOccupiedSpaceCostFunction2D(
    double scaling_factor, const sensor::PointCloud& point_cloud,
    const Grid2D& grid);

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_OCCUPIED_SPACE_COST_FUNCTION_2D_H_
