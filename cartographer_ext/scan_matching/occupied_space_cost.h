// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Cost of a scan in a grid of correspondence costs, with derivatives (paper G,
// improved graph optimisation 2024, eq. 14 to 16).
//
// A point p of the scan, seen from the pose xi = (x, y, theta), is at
//
//   G eq. 14   w(xi) = R(theta) p + (x, y)
//
// and costs c(w), interpolated between the cells by the bicubic Catmull-Rom
// spline (the M_smooth of the paper, as 1 - probability). The scan costs the
// sum of squares (eq. 16). The cost is that of the stock matcher, where Ceres
// interpolates; cells outside the grid cost 0.9 there as here.
//
// With n and f the whole and fractional part of a cell index, the weights of
// the cells n-1, n, n+1, n+2 are
//
//   u(f) = (-f + 2f^2 - f^3, 2 - 5f^2 + 3f^3, f + 4f^2 - 3f^3, f^3 - f^2) / 2,
//
// In the stock matcher an unknown cell costs as much as a free one. The walls
// of a map end at the limit of the laser's range; a new scan extends beyond
// them by the motion of the robot, and matches better if the robot has moved
// less. With a laser of 4.5 m in a corridor this shortens a path by 3 %. What
// was seen last has also been hit least, so that the cost rises towards the end
// of a wall. Therefore unknown cells cost 0.5 (even odds) for points at the limit
// of the range, and such a point constrains the pose only across its wall: its
// place is
//
//   w(xi) = a + n n^T (R(theta) p + (x, y) - a),
//
// with a its place at the initial pose and n the unit vector across the wall
// (wall_normals.h).
//
// c = u(f_row)^T P u(f_column) with P the 4 x 4 cells around the point, and the
// derivatives have u' in place of one u. The solver evaluates a scan a few
// times at nearly the same pose, so P is reused while the point stays in its
// cell. The arithmetic is done for several points at once (bicubic_kernels.h).
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_OCCUPIED_SPACE_COST_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_OCCUPIED_SPACE_COST_H_

#include <cmath>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/bicubic_kernels.h"

namespace cartographer_ext {
namespace scan_matching {

// The points at the limit of the range, which are the last ones of a scan.
struct PointsAtLimit {
  Pose2 initial;  // grid <- node
  // Of each the unit vector across its wall, in the frame of the node; zero: the
  // point does not constrain the pose.
  std::vector<Eigen::Vector2d> normals;
};

// Sums over the points of a scan at one pose.
struct OccupiedSpaceSums {
  double squares = 0.;                                 // sum of c^2
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // sum of c grad c
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   // sum of grad c grad c^T
};

// `Cells` is a grid of costs whose cell (row, column) has its centre at
//   x = max_x() - resolution() (row + 1/2)
//   y = max_y() - resolution() (column + 1/2)
//
//   double resolution() const, max_x() const, max_y() const;  // metres
//   int num_rows() const, num_columns() const;
//   // Of `count` <= 4 cells along the row, inside only.
//   void CopyCosts(int row, int column, int count, float* costs) const;
//   bool IsKnown(int row, int column) const;                  // inside only
template <typename Cells>
class OccupiedSpaceCost {
 public:
  // Cost of everything outside the grid.
  static constexpr float kOutside = 0.9f;
  // Cost of unknown cells for points at the limit of the range.
  static constexpr float kUnknownAtLimit = 0.5f;

  // `points` in metres, in the frame of the node; no fewer than `at_limit`.
  // `cells` must outlive this object.
  OccupiedSpaceCost(const Cells* cells, std::vector<Eigen::Vector2d> points,
                    const BicubicKernels& kernels = BestBicubicKernels(),
                    const PointsAtLimit& at_limit = PointsAtLimit())
      : cells_(*cells),
        points_(std::move(points)),
        num_near_(points_.size() - at_limit.normals.size()),
        kernels_(kernels),
        cells_per_metre_(1. / cells->resolution()),
        // An odd number of half cache lines.
        stride_((static_cast<int>(points_.size()) + 3) / 8 * 8 + 4),
        arrays_(static_cast<size_t>(kNumArrays) * stride_),
        patches_(points_.size()) {
    for (size_t i = 0; i != points_.size(); ++i) {
      Array(kPointX)[i] = points_[i].x();
      Array(kPointY)[i] = points_[i].y();
    }
    const Eigen::Rotation2Dd rotation(at_limit.initial.theta);
    for (size_t i = num_near_; i != points_.size(); ++i) {
      const Eigen::Vector2d place = at_limit.initial * points_[i];
      Wall wall;
      wall.row = (cells_.max_x() - place.x()) * cells_per_metre_ - 0.5;
      wall.column = (cells_.max_y() - place.y()) * cells_per_metre_ - 0.5;
      wall.normal = rotation * at_limit.normals[i - num_near_];
      walls_.push_back(wall);
    }
  }

  const std::vector<Eigen::Vector2d>& points() const { return points_; }

  // At the pose (grid <- node). Not const: cells are cached.
  OccupiedSpaceSums Evaluate(const Pose2& pose) {
    Sample(pose);
    const double* const costs = Array(kCost);
    const double* const row_slopes = Array(kRowSlope);
    const double* const column_slopes = Array(kColumnSlope);
    const double* const turned_x = Array(kTurnedX);
    const double* const turned_y = Array(kTurnedY);
    OccupiedSpaceSums sums;
    double h00 = 0., h01 = 0., h02 = 0., h11 = 0., h12 = 0., h22 = 0.;
    for (size_t i = 0; i != points_.size(); ++i) {
      const double cost = costs[i];
      const double per_x = -cells_per_metre_ * row_slopes[i];
      const double per_y = -cells_per_metre_ * column_slopes[i];
      const double per_theta = per_y * turned_x[i] - per_x * turned_y[i];
      sums.squares += cost * cost;
      sums.gradient.x() += cost * per_x;
      sums.gradient.y() += cost * per_y;
      sums.gradient.z() += cost * per_theta;
      h00 += per_x * per_x;
      h01 += per_x * per_y;
      h02 += per_x * per_theta;
      h11 += per_y * per_y;
      h12 += per_y * per_theta;
      h22 += per_theta * per_theta;
    }
    sums.hessian << h00, h01, h02, h01, h11, h12, h02, h12, h22;
    return sums;
  }

  // The sum of c^2 with linear interpolation between cells: several times
  // faster, and accurate enough for steps of whole cells.
  double LinearSquares(const Pose2& pose) const {
    const double cosine = std::cos(pose.theta) * cells_per_metre_;
    const double sine = std::sin(pose.theta) * cells_per_metre_;
    const double row_of_origin =
        (cells_.max_x() - pose.x) * cells_per_metre_ - 0.5;
    const double column_of_origin =
        (cells_.max_y() - pose.y) * cells_per_metre_ - 0.5;
    const double last_row = cells_.num_rows() - 1.;
    const double last_column = cells_.num_columns() - 1.;
    double squares = 0.;
    for (size_t i = 0; i != points_.size(); ++i) {
      const Eigen::Vector2d& point = points_[i];
      const bool near = i < num_near_;
      double row = row_of_origin - cosine * point.x() + sine * point.y();
      double column = column_of_origin - sine * point.x() - cosine * point.y();
      if (!near) walls_[i - num_near_].Project(&row, &column);
      double cost = near ? kOutside : kUnknownAtLimit;
      if (row >= 0. && row < last_row && column >= 0. && column < last_column) {
        const int r = static_cast<int>(row);
        const int c = static_cast<int>(column);
        const double v = row - r;
        const double u = column - c;
        float here[2], below[2];
        CopyCostsFor(near, r, c, 2, here);
        CopyCostsFor(near, r + 1, c, 2, below);
        cost = (1. - v) * ((1. - u) * here[0] + u * here[1]) +
               v * ((1. - u) * below[0] + u * below[1]);
      }
      squares += cost * cost;
    }
    return squares;
  }

  // Cost at one place of the grid, and its derivatives per metre.
  void CostAt(const double x, const double y, double* const cost,
              double* const per_x, double* const per_y) const {
    OccupiedSpaceCost place(&cells_, {Eigen::Vector2d(x, y)}, kernels_);
    place.Sample(Pose2());
    *cost = *place.Array(kCost);
    *per_x = -cells_per_metre_ * *place.Array(kRowSlope);
    *per_y = -cells_per_metre_ * *place.Array(kColumnSlope);
  }

 private:
  // The 4 x 4 cells from (row - 1, column - 1) on that are cached for a point.
  struct Patch {
    int row = kNoRow;
    int column = 0;
    bool is_outside = false;
  };
  static constexpr int kNoRow = -1000000;

  // Of a point at the limit: where it is at the initial pose, cells, and the unit
  // vector across its wall in the grid.
  struct Wall {
    double row = 0.;
    double column = 0.;
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();

    // The part of a displacement or slope across the wall.
    void KeepAcross(double* const r, double* const c) const {
      const double across = normal.x() * *r + normal.y() * *c;
      *r = across * normal.x();
      *c = across * normal.y();
    }
    // Moves a place along the wall to the initial one.
    void Project(double* const r, double* const c) const {
      *r -= row;
      *c -= column;
      KeepAcross(r, c);
      *r += row;
      *c += column;
    }
  };

  // Arrays with one element per point; the last are the 16 cells, column by
  // column.
  enum ArrayName {
    kPointX,
    kPointY,
    kTurnedX,
    kTurnedY,
    kRow,
    kColumn,
    kCost,
    kRowSlope,
    kColumnSlope,
    kCells,
    kNumArrays = kCells + 16
  };
  double* Array(const int name) {
    return arrays_.data() + static_cast<size_t>(name) * stride_;
  }

  // Costs of all points at a pose, and their slopes per cell.
  void Sample(const Pose2& pose) {
    const int num_points = static_cast<int>(points_.size());
    double* const rows = Array(kRow);
    double* const columns = Array(kColumn);
    kernels_.find_places(
        GridFrame{cells_.max_x(), cells_.max_y(), cells_per_metre_},
        std::cos(pose.theta), std::sin(pose.theta), pose.x, pose.y,
        Array(kPointX), Array(kPointY), num_points,
        PointPlaces{Array(kTurnedX), Array(kTurnedY), rows, columns});
    for (size_t i = 0; i != walls_.size(); ++i) {
      walls_[i].Project(&rows[num_near_ + i], &columns[num_near_ + i]);
    }
    const double end_row = cells_.num_rows() + 1.;
    const double end_column = cells_.num_columns() + 1.;
    bool any_outside = false;
    for (int i = 0; i != num_points; ++i) {
      // Otherwise none of the 16 cells is inside; also catches what is not a
      // number and what does not fit an integer.
      const bool is_inside = rows[i] >= -2. && rows[i] < end_row &&
                             columns[i] >= -2. && columns[i] < end_column;
      patches_[i].is_outside = !is_inside;
      any_outside = any_outside || !is_inside;
      if (!is_inside) {
        rows[i] = columns[i] = 0.;
        continue;
      }
      const int row = Floor(rows[i]);
      const int column = Floor(columns[i]);
      rows[i] -= row;
      columns[i] -= column;
      Load(row, column, i);
    }
    kernels_.interpolate(Array(kCells), stride_, rows, columns, num_points,
                         Array(kCost), Array(kRowSlope), Array(kColumnSlope));
    for (int i = 0; any_outside && i != num_points; ++i) {
      if (!patches_[i].is_outside) continue;
      Array(kCost)[i] =
          static_cast<size_t>(i) < num_near_ ? kOutside : kUnknownAtLimit;
      Array(kRowSlope)[i] = Array(kColumnSlope)[i] = 0.;
    }
    for (size_t i = 0; i != walls_.size(); ++i) {
      walls_[i].KeepAcross(Array(kRowSlope) + num_near_ + i,
                           Array(kColumnSlope) + num_near_ + i);
    }
  }

  static int Floor(const double x) {
    const int cut = static_cast<int>(x);
    return cut - (x < cut);
  }

  // Of `count` <= 4 cells inside the grid, along the row.
  void CopyCostsFor(const bool near, const int row, const int column,
                    const int count, float* const costs) const {
    cells_.CopyCosts(row, column, count, costs);
    for (int j = 0; !near && j != count; ++j) {
      if (!cells_.IsKnown(row, column + j)) costs[j] = kUnknownAtLimit;
    }
  }

  void Load(const int row, const int column, const int point) {
    Patch* const patch = &patches_[point];
    if (patch->row == row && patch->column == column) return;
    patch->row = row;
    patch->column = column;
    double* const cells = Array(kCells) + point;
    const int num_rows = cells_.num_rows();
    const int num_columns = cells_.num_columns();
    const bool near = static_cast<size_t>(point) < num_near_;
    const bool is_whole = row >= 1 && row + 2 < num_rows && column >= 1 &&
                          column + 2 < num_columns;
    for (int i = 0; i != 4; ++i) {
      const int r = row - 1 + i;
      float costs[4];
      if (is_whole) {
        CopyCostsFor(near, r, column - 1, 4, costs);
      } else {
        for (int j = 0; j != 4; ++j) {
          const int c = column - 1 + j;
          costs[j] = near ? kOutside : kUnknownAtLimit;
          if (r >= 0 && r < num_rows && c >= 0 && c < num_columns) {
            CopyCostsFor(near, r, c, 1, &costs[j]);
          }
        }
      }
      for (int j = 0; j != 4; ++j) cells[(4 * j + i) * stride_] = costs[j];
    }
  }

  const Cells& cells_;
  const std::vector<Eigen::Vector2d> points_;
  const size_t num_near_;
  const BicubicKernels& kernels_;
  const double cells_per_metre_;
  const int stride_;
  std::vector<double> arrays_;
  std::vector<Patch> patches_;
  std::vector<Wall> walls_;  // of the points from num_near_ on
};

template <typename Cells>
constexpr float OccupiedSpaceCost<Cells>::kOutside;
template <typename Cells>
constexpr float OccupiedSpaceCost<Cells>::kUnknownAtLimit;
template <typename Cells>
constexpr int OccupiedSpaceCost<Cells>::kNoRow;

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_OCCUPIED_SPACE_COST_H_
