// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_2D_MAP_LIMITS_H_
#define CARTOGRAPHER_MAPPING_2D_MAP_LIMITS_H_

#include "Eigen/Core"
#include "cartographer/common/port.h"
#include "cartographer/mapping/2d/xy_index.h"
#include "cartographer/mapping/proto/map_limits.pb.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

// Where a grid lies in the world. `max` is the corner with the largest x and y
// (metres); cell (0, 0) touches it. Cell (ix, iy) has its centre at
//   x = max.x - resolution * (iy + 0.5),  y = max.y - resolution * (ix + 0.5).
class MapLimits {
 public:
  MapLimits(const double resolution, const Eigen::Vector2d& max,
            const CellLimits& cell_limits)
      : resolution_(resolution), max_(max), cell_limits_(cell_limits) {
    CHECK_GT(resolution_, 0.);
    CHECK_GT(cell_limits_.num_x_cells, 0);
    CHECK_GT(cell_limits_.num_y_cells, 0);
  }
  explicit MapLimits(const proto::MapLimits& map_limits)
      : resolution_(map_limits.resolution()),
        max_(transform::ToEigen(map_limits.max())),
        cell_limits_(map_limits.cell_limits()) {}

  double resolution() const { return resolution_; }
  const Eigen::Vector2d& max() const { return max_; }
  const CellLimits& cell_limits() const { return cell_limits_; }

  // The cell that contains `point`; outside the grid the index is negative or
  // too large.
  Eigen::Array2i GetCellIndex(const Eigen::Vector2f& point) const {
    const Eigen::Vector2d from_corner = max_ - point.cast<double>();
    const Eigen::Vector2d cells =
        from_corner / resolution_ - Eigen::Vector2d::Constant(0.5);
    return {common::RoundToInt(cells.y()), common::RoundToInt(cells.x())};
  }

  Eigen::Vector2f GetCellCenter(const Eigen::Array2i& cell_index) const {
    const Eigen::Vector2d cells = cell_index.reverse().cast<double>() + 0.5;
    return (max_ - resolution_ * cells).cast<float>();
  }

  bool Contains(const Eigen::Array2i& cell_index) const {
    // As unsigned numbers negative indices are too large as well.
    return static_cast<unsigned>(cell_index.x()) <
               static_cast<unsigned>(cell_limits_.num_x_cells) &&
           static_cast<unsigned>(cell_index.y()) <
               static_cast<unsigned>(cell_limits_.num_y_cells);
  }

 private:
  double resolution_;
  Eigen::Vector2d max_;
  CellLimits cell_limits_;
};

inline proto::MapLimits ToProto(const MapLimits& map_limits) {
  proto::MapLimits result;
  result.set_resolution(map_limits.resolution());
  *result.mutable_max() = transform::ToProto(map_limits.max());
  *result.mutable_cell_limits() = ToProto(map_limits.cell_limits());
  return result;
}

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_2D_MAP_LIMITS_H_
