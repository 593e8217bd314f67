// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A corridor with doors that all look alike, and scans made up in it, so that
// the examples need no data.
#ifndef EXAMPLES_CORRIDOR_H_
#define EXAMPLES_CORRIDOR_H_

#include <cmath>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace examples {

// Occupied where a wall is, free elsewhere.
inline bool IsWall(const double x, const double y) {
  if (x < 0. || x > 20. || y < 0. || y > 5.) return true;
  // Rooms above the corridor, 2.5 m wide, each with a door of one metre.
  if (y > 2. && y < 2.1) return std::fmod(x, 2.5) > 1.;
  if (y >= 2.1) return std::fmod(x, 2.5) > 2.4;
  // A cupboard in the corridor.
  return x > 13.2 && x < 14. && y < 0.4;
}

// An occupancy grid: 1 occupied, 0 free, row by row from the smallest y up.
struct Map {
  int width = 404;                                 // cells along x
  int height = 104;                                // cells along y
  double resolution = 0.05;                        // metres a cell
  cartographer_ext::Pose2 origin{-0.1, -0.1, 0.};  // corner of cell (0, 0)
  std::vector<float> occupancy;

  float at(const int x, const int y) const { return occupancy[y * width + x]; }
};

inline Map Corridor() {
  Map map;
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const bool wall = IsWall(map.origin.x + (i + 0.5) * map.resolution,
                               map.origin.y + (j + 0.5) * map.resolution);
      map.occupancy.push_back(wall ? 1.f : 0.f);
    }
  }
  return map;
}

// The points of a stationary laser with 180 beams all around and 8 m of range at
// `pose` (map <- laser), in the frame of the laser.
inline std::vector<Eigen::Vector2f> Scan(const cartographer_ext::Pose2& pose) {
  std::vector<Eigen::Vector2f> points;
  for (int beam = 0; beam < 180; ++beam) {
    const double angle = cartographer_ext::DegToRad(2. * beam);
    for (double range = 0.1; range < 8.; range += 0.01) {
      const Eigen::Vector2d in_laser(range * std::cos(angle),
                                     range * std::sin(angle));
      const Eigen::Vector2d in_map = pose * in_laser;
      if (!IsWall(in_map.x(), in_map.y())) continue;
      points.push_back(in_laser.cast<float>());
      break;
    }
  }
  return points;
}

}  // namespace examples

#endif  // EXAMPLES_CORRIDOR_H_
