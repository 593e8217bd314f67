// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Directions across the walls that a scan shows.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_WALL_NORMALS_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_WALL_NORMALS_H_

#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace scan_matching {

// Of the points from `first` on, unit vectors across the wall that each lies
// on, in the frame of the points (metres): across the line through the points
// around it. Zero where there are too few to tell, or no line.
std::vector<Eigen::Vector2d> WallNormals(
    const std::vector<Eigen::Vector2d>& points, int first);

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_WALL_NORMALS_H_
