// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Fills the gaps between the points of a straight wall.
//
// A laser with a beam every degree sees a wall ten metres ahead, or one along
// its line of sight, as points further apart than the cells of the grid. The
// next scan has its points at the same angles; matched with the points of the
// first it fits best where the robot has not moved at all. A grid with complete
// walls has no such local optimum. So before a scan is inserted, gaps between
// successive points are filled where the wall certainly continues: where four
// successive points lie on one line.
#ifndef CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_WALL_FILLING_H_
#define CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_WALL_FILLING_H_

#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

// Spacing of new points, and limits for a wall.
struct WallFillingOptions {
  double spacing = 0.05;  // metres between the points of a filled wall, > 0
  // Wider gaps are left open, as doors are; metres.
  double max_gap = 1.;
  // Metres that a point may be off the line: about twice the noise of a laser.
  double tolerance = 0.04;
};

// New points only, in order. `points` in the order of the beams, metres.
// Points that are not finite interrupt a wall.
std::vector<Eigen::Vector3f> FillWalls(
    const WallFillingOptions& options,
    const std::vector<Eigen::Vector3f>& points);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_POINT_CLOUD_WALL_FILLING_H_
