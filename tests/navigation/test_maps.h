// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Small maps and scans for the tests of navigation.
#ifndef CARTOGRAPHER_EXT_TESTS_NAVIGATION_TEST_MAPS_H_
#define CARTOGRAPHER_EXT_TESTS_NAVIGATION_TEST_MAPS_H_

#include <cmath>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/navigation/costmap.h"
#include "cartographer_ext/navigation/grid_search.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {

// A map from a drawing, the top row first: '#' occupied, '?' unknown, else
// free.
inline io::OccupancyMap DrawMap(const std::vector<std::string>& rows,
                                const double resolution,
                                const Pose2& origin = Pose2()) {
  io::OccupancyMap map = io::OccupancyMap::Make(
      rows.front().size(), rows.size(), resolution, origin);
  for (int y = 0; y != map.height; ++y) {
    for (int x = 0; x != map.width; ++x) {
      const char c = rows[map.height - 1 - y][x];
      map.at(x, y) = c == '#'   ? 1.f
                     : c == '?' ? io::OccupancyMap::Unknown()
                                : 0.f;
    }
  }
  return map;
}

// A free room of so many metres with walls of two cells, lower left at (0, 0).
inline io::OccupancyMap RoomMap(const double width, const double height,
                                const double resolution = 0.05) {
  const int nx = std::lround(width / resolution);
  const int ny = std::lround(height / resolution);
  io::OccupancyMap map = io::OccupancyMap::Make(nx, ny, resolution, Pose2());
  for (int y = 0; y != ny; ++y) {
    for (int x = 0; x != nx; ++x) {
      map.at(x, y) = x < 2 || y < 2 || x >= nx - 2 || y >= ny - 2 ? 1.f : 0.f;
    }
  }
  return map;
}

// Makes the cells of a box occupied (or free).
inline void FillBox(const double x0, const double y0, const double x1,
                    const double y1, const float value,
                    io::OccupancyMap* const map) {
  for (int y = 0; y != map->height; ++y) {
    for (int x = 0; x != map->width; ++x) {
      const Eigen::Vector2d p =
          map->origin * Eigen::Vector2d((x + 0.5) * map->resolution,
                                        (y + 0.5) * map->resolution);
      if (p.x() >= x0 && p.x() <= x1 && p.y() >= y0 && p.y() <= y1) {
        map->at(x, y) = value;
      }
    }
  }
}

inline io::OccupancyMap RandomMap(const int width, const int height,
                                  const double occupied, const double unknown,
                                  Random* const random) {
  io::OccupancyMap map = io::OccupancyMap::Make(width, height, 0.1, Pose2());
  for (float& value : map.occupancy) {
    const double draw = random->Uniform();
    value = draw < occupied             ? 1.f
            : draw < occupied + unknown ? io::OccupancyMap::Unknown()
                                        : 0.f;
  }
  return map;
}

inline Costmap MakeCostmap(const io::OccupancyMap& map,
                           const CostmapOptions& options = CostmapOptions()) {
  auto costmap = Costmap::Create(map, options);
  CHECK(costmap.ok()) << costmap.status();
  return *std::move(costmap);
}

// Echoes in the robot frame of a laser at the robot's origin, by walking
// through the map.
inline std::vector<Eigen::Vector2d> ScanOf(const io::OccupancyMap& map,
                                           const Pose2& robot,
                                           const int beams = 360,
                                           const double max_range = 20.) {
  std::vector<Eigen::Vector2d> echoes;
  const Pose2 grid_from_map = map.origin.Inverse();
  for (int i = 0; i != beams; ++i) {
    const double angle = 2. * kPi * i / beams;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    for (double range = 0.; range < max_range; range += 0.01) {
      const Eigen::Vector2d p =
          (grid_from_map * (robot * Eigen::Vector2d(range * direction))) /
          map.resolution;
      const int x = std::floor(p.x()), y = std::floor(p.y());
      if (x < 0 || y < 0 || x >= map.width || y >= map.height) break;
      if (map.at(x, y) > 0.5f) {
        echoes.push_back(range * direction);
        break;
      }
    }
  }
  return echoes;
}

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TESTS_NAVIGATION_TEST_MAPS_H_
