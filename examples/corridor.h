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
#include "cartographer_ext/io/occupancy_map.h"

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

inline cartographer_ext::io::OccupancyMap Corridor() {
  constexpr double kResolution = 0.05;
  auto map = cartographer_ext::io::OccupancyMap::Make(
      404, 104, kResolution, cartographer_ext::Pose2(-0.1, -0.1, 0.));
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      map.at(i, j) = IsWall(map.origin.x + (i + 0.5) * kResolution,
                            map.origin.y + (j + 0.5) * kResolution)
                         ? 1.f
                         : 0.f;
    }
  }
  return map;
}

// The points of a laser with 180 beams all around and 8 m of range that stands
// at `pose` (map <- laser), in the frame of the laser.
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
