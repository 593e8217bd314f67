// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How badly a scan fits a grid of correspondence costs, with derivatives
// (paper G, improved graph optimisation 2024, eq. 14 to 16).
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
// c = u(f_row)^T P u(f_column) with P the 4 x 4 cells around the point, and the
// derivatives have u' in place of one u. The solver evaluates a scan a few
// times at nearly the same pose, so P is kept as long as the point stays in its
// cell; reading the 16 cells is most of the work.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_OCCUPIED_SPACE_COST_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_OCCUPIED_SPACE_COST_H_

#include <cmath>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace scan_matching {

// Weights of four neighbouring cells, and their derivatives by the fraction.
struct CubicWeights {
  Eigen::Array4d value;
  Eigen::Array4d slope;

  explicit CubicWeights(const double f) {
    const double f2 = f * f;
    const double f3 = f2 * f;
    value << 0.5 * (-f + 2. * f2 - f3), 0.5 * (2. - 5. * f2 + 3. * f3),
        0.5 * (f + 4. * f2 - 3. * f3), 0.5 * (f3 - f2);
    slope << 0.5 * (-1. + 4. * f - 3. * f2), 0.5 * (-10. * f + 9. * f2),
        0.5 * (1. + 8. * f - 9. * f2), 0.5 * (3. * f2 - 2. * f);
  }
};

// Sums over the points of a scan at one pose.
struct OccupiedSpaceSums {
  double squares = 0.;                                 // sum of c^2
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // sum of c grad c
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   // sum of grad c grad c^T
};

// `Cells` is a grid of costs whose cell (row, column) has its centre at
//   x = max_x() - resolution() (row + 1/2), y = max_y() - resolution() (column
//   + 1/2):
//
//   double resolution() const, max_x() const, max_y() const;  // metres
//   int num_rows() const, num_columns() const;
//   float Cost(int row, int column) const;                    // inside only
template <typename Cells>
class OccupiedSpaceCost {
 public:
  // Cost of everything outside the grid.
  static constexpr float kOutside = 0.9f;

  // `points` in metres, in the frame of the node. `cells` must outlive this.
  OccupiedSpaceCost(const Cells* cells, std::vector<Eigen::Vector2d> points)
      : cells_(*cells),
        points_(std::move(points)),
        cells_per_metre_(1. / cells->resolution()),
        patches_(points_.size()) {}

  const std::vector<Eigen::Vector2d>& points() const { return points_; }

  // At the pose (grid <- node). Not const: patches are kept.
  OccupiedSpaceSums Evaluate(const Pose2& pose) {
    OccupiedSpaceSums sums;
    double h00 = 0., h01 = 0., h02 = 0., h11 = 0., h12 = 0., h22 = 0.;
    const double cosine = std::cos(pose.theta);
    const double sine = std::sin(pose.theta);
    for (size_t i = 0; i != points_.size(); ++i) {
      // The point turned into the frame of the grid, without translation.
      const double turned_x = cosine * points_[i].x() - sine * points_[i].y();
      const double turned_y = sine * points_[i].x() + cosine * points_[i].y();
      double cost, per_x, per_y;
      Sample(turned_x + pose.x, turned_y + pose.y, &patches_[i], &cost, &per_x,
             &per_y);
      const double per_theta = per_y * turned_x - per_x * turned_y;
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

  // The sum of c^2 with linear interpolation between cells: a few times faster,
  // and good enough for steps of whole cells.
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
    for (const Eigen::Vector2d& point : points_) {
      const double row = row_of_origin - cosine * point.x() + sine * point.y();
      const double column =
          column_of_origin - sine * point.x() - cosine * point.y();
      double cost = kOutside;
      if (row >= 0. && row < last_row && column >= 0. && column < last_column) {
        const int r = static_cast<int>(row);
        const int c = static_cast<int>(column);
        const double v = row - r;
        const double u = column - c;
        cost = (1. - v) *
                   ((1. - u) * cells_.Cost(r, c) + u * cells_.Cost(r, c + 1)) +
               v * ((1. - u) * cells_.Cost(r + 1, c) +
                    u * cells_.Cost(r + 1, c + 1));
      }
      squares += cost * cost;
    }
    return squares;
  }

  // Cost at one place of the grid, and its derivatives per metre.
  void CostAt(const double x, const double y, double* const cost,
              double* const per_x, double* const per_y) const {
    Patch patch;
    Sample(x, y, &patch, cost, per_x, per_y);
  }

 private:
  // The 4 x 4 cells from (row - 1, column - 1) on, row by row.
  struct Patch {
    int row = kNoRow;
    int column = 0;
    Eigen::Matrix<float, 4, 4, Eigen::ColMajor> cells;
  };
  static constexpr int kNoRow = -1000000;

  void Sample(const double x, const double y, Patch* const patch,
              double* const cost, double* const per_x,
              double* const per_y) const {
    const double row = (cells_.max_x() - x) * cells_per_metre_ - 0.5;
    const double column = (cells_.max_y() - y) * cells_per_metre_ - 0.5;
    // None of the 16 cells is inside; also catches what is not a number and
    // what does not fit an integer.
    if (!(row >= -2. && row < cells_.num_rows() + 1. && column >= -2. &&
          column < cells_.num_columns() + 1.)) {
      *cost = kOutside;
      *per_x = 0.;
      *per_y = 0.;
      return;
    }
    const double whole_row = std::floor(row);
    const double whole_column = std::floor(column);
    Load(static_cast<int>(whole_row), static_cast<int>(whole_column), patch);
    const CubicWeights by_row(row - whole_row);
    const CubicWeights by_column(column - whole_column);
    // Column j of the matrix holds the four cells of grid column j.
    Eigen::Array4d value = Eigen::Array4d::Zero();
    Eigen::Array4d slope = Eigen::Array4d::Zero();
    for (int j = 0; j != 4; ++j) {
      const Eigen::Array4d cells =
          patch->cells.col(j).array().template cast<double>();
      value += by_column.value(j) * cells;
      slope += by_column.slope(j) * cells;
    }
    *cost = (by_row.value * value).sum();
    *per_x = -cells_per_metre_ * (by_row.slope * value).sum();
    *per_y = -cells_per_metre_ * (by_row.value * slope).sum();
  }

  void Load(const int row, const int column, Patch* const patch) const {
    if (patch->row == row && patch->column == column) return;
    patch->row = row;
    patch->column = column;
    const int num_rows = cells_.num_rows();
    const int num_columns = cells_.num_columns();
    if (row >= 1 && row + 2 < num_rows && column >= 1 &&
        column + 2 < num_columns) {
      for (int i = 0; i != 4; ++i) {
        for (int j = 0; j != 4; ++j) {
          patch->cells(i, j) = cells_.Cost(row - 1 + i, column - 1 + j);
        }
      }
      return;
    }
    for (int i = 0; i != 4; ++i) {
      for (int j = 0; j != 4; ++j) {
        const int r = row - 1 + i;
        const int c = column - 1 + j;
        patch->cells(i, j) = r >= 0 && r < num_rows && c >= 0 && c < num_columns
                                 ? cells_.Cost(r, c)
                                 : kOutside;
      }
    }
  }

  const Cells& cells_;
  const std::vector<Eigen::Vector2d> points_;
  const double cells_per_metre_;
  std::vector<Patch> patches_;
};

template <typename Cells>
constexpr float OccupiedSpaceCost<Cells>::kOutside;
template <typename Cells>
constexpr int OccupiedSpaceCost<Cells>::kNoRow;

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_OCCUPIED_SPACE_COST_H_
