// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the cells of a map lie: cell (x, y) is the square of one resolution
// whose lower left corner is at (x, y) * resolution in the frame of the grid,
// and `origin` is (map <- grid).
#ifndef CARTOGRAPHER_EXT_NAVIGATION_GRID_GEOMETRY_H_
#define CARTOGRAPHER_EXT_NAVIGATION_GRID_GEOMETRY_H_

#include <cmath>
#include <cstddef>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/occupancy_map.h"

namespace cartographer_ext {
namespace navigation {

struct Cell {
  int x = 0;
  int y = 0;
};

inline bool operator==(const Cell& a, const Cell& b) {
  return a.x == b.x && a.y == b.y;
}
inline bool operator!=(const Cell& a, const Cell& b) { return !(a == b); }

class GridGeometry {
 public:
  GridGeometry() = default;
  GridGeometry(const int width, const int height, const double resolution,
               const Pose2& origin)
      : width_(width),
        height_(height),
        resolution_(resolution),
        origin_(origin),
        grid_from_map_(origin.Inverse()) {}
  explicit GridGeometry(const io::OccupancyMap& map)
      : GridGeometry(map.width, map.height, map.resolution, map.origin) {}

  int width() const { return width_; }
  int height() const { return height_; }
  double resolution() const { return resolution_; }  // metres
  const Pose2& origin() const { return origin_; }
  size_t size() const { return static_cast<size_t>(width_) * height_; }

  bool Contains(const Cell& cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < width_ && cell.y < height_;
  }
  size_t Index(const Cell& cell) const {
    return static_cast<size_t>(cell.y) * width_ + cell.x;
  }
  Cell CellOfIndex(const size_t index) const {
    return {static_cast<int>(index % width_), static_cast<int>(index / width_)};
  }

  // In cells, from the lower left corner of cell (0, 0).
  Eigen::Vector2d ToGrid(const Eigen::Vector2d& in_map) const {
    return (grid_from_map_ * in_map) / resolution_;
  }
  // The point must be finite; one far away yields a cell outside.
  Cell CellAt(const Eigen::Vector2d& in_map) const {
    const Eigen::Vector2d p = ToGrid(in_map);
    return {ToInt(p.x()), ToInt(p.y())};
  }
  // Centre of a cell in the map.
  Eigen::Vector2d Center(const Cell& cell) const {
    return origin_ * Eigen::Vector2d((cell.x + 0.5) * resolution_,
                                     (cell.y + 0.5) * resolution_);
  }

 private:
  static int ToInt(const double value) {
    return static_cast<int>(std::floor(std::fmax(-1e9, std::fmin(1e9, value))));
  }

  int width_ = 0;
  int height_ = 0;
  double resolution_ = 1.;
  Pose2 origin_;         // (map <- grid)
  Pose2 grid_from_map_;  // (grid <- map)
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_GRID_GEOMETRY_H_
