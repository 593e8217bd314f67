// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Nearest neighbours within a fixed radius, by a hash of square cells.
#ifndef CARTOGRAPHER_EXT_MAP_COMPARISON_POINT_INDEX_H_
#define CARTOGRAPHER_EXT_MAP_COMPARISON_POINT_INDEX_H_

#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "Eigen/Core"

namespace cartographer_ext {
namespace evaluation {

class PointIndex {
 public:
  // `radius` in metres, positive. `points` must outlive this object.
  PointIndex(const std::vector<Eigen::Vector2d>& points, const double radius)
      : points_(points), radius_(radius) {
    for (size_t i = 0; i < points.size(); ++i) {
      cells_[Key(Cell(points[i].x()), Cell(points[i].y()))].push_back(
          static_cast<int>(i));
    }
  }

  // Index of the nearest point, the first of equally near ones; -1 if there is
  // none within the radius.
  int Nearest(const Eigen::Vector2d& place) const {
    int nearest = -1;
    double best = radius_ * radius_;
    const int64_t x = Cell(place.x()), y = Cell(place.y());
    for (int64_t ix = x - 1; ix <= x + 1; ++ix) {
      for (int64_t iy = y - 1; iy <= y + 1; ++iy) {
        const auto cell = cells_.find(Key(ix, iy));
        if (cell == cells_.end()) continue;
        for (const int i : cell->second) {
          const double distance = (points_[i] - place).squaredNorm();
          if (distance < best || (distance == best && i < nearest)) {
            best = distance;
            nearest = i;
          }
        }
      }
    }
    return nearest;
  }

 private:
  int64_t Cell(const double metres) const {
    return static_cast<int64_t>(std::floor(metres / radius_));
  }
  // Unsigned: shifting a negative number is undefined.
  static uint64_t Key(const int64_t x, const int64_t y) {
    return static_cast<uint64_t>(x) << 32 ^ static_cast<uint32_t>(y);
  }

  const std::vector<Eigen::Vector2d>& points_;
  const double radius_;
  std::unordered_map<uint64_t, std::vector<int>> cells_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_COMPARISON_POINT_INDEX_H_
