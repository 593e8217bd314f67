// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/occupied_space_cost_function_2d.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer/mapping/probability_values.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

// The order of every sum and product below is that of Cartographer, where the
// same terms come from Jets and ceres::BiCubicInterpolator: with it, a whole
// run of local SLAM agrees with Cartographer's to the last bit, without it only
// as long as no rounding error has turned the choice of a voxel or cell.

// Cartographer shifts indices by this much to keep them positive, which rounds
// them to a multiple of 2^-23 cells.
constexpr double kIndexShift = 536870911.;

double RoundIndex(const double index) {
  return (index + kIndexShift) - kIndexShift;
}

// The cubic through four equidistant samples, between the middle two, of the
// Catmull-Rom spline; x in [0, 1).
class Cubic {
 public:
  Cubic(const double p0, const double p1, const double p2, const double p3)
      : a_(0.5 * (-p0 + 3. * p1 - 3. * p2 + p3)),
        b_(0.5 * (2. * p0 - 5. * p1 + 4. * p2 - p3)),
        c_(0.5 * (-p0 + p2)),
        d_(p1) {}

  double Value(const double x) const {
    return d_ + x * (c_ + x * (b_ + x * a_));
  }
  double Slope(const double x) const {
    return c_ + x * (2. * b_ + 3. * a_ * x);
  }

 private:
  const double a_;
  const double b_;
  const double c_;
  const double d_;
};

class OccupiedSpaceCostFunction2D : public ceres::CostFunction {
 public:
  OccupiedSpaceCostFunction2D(const double scaling_factor,
                              const sensor::PointCloud& point_cloud,
                              const Grid2D& grid)
      : scaling_factor_(scaling_factor),
        point_cloud_(point_cloud),
        limits_(grid.limits()),
        grid_(grid),
        value_to_cost_(grid.value_to_correspondence_cost()) {
    set_num_residuals(static_cast<int>(point_cloud.size()));
    mutable_parameter_block_sizes()->push_back(3);
  }

  bool Evaluate(const double* const* const parameters, double* const residuals,
                double** const jacobians) const override {
    const double* const pose = parameters[0];
    double* const jacobian = jacobians == nullptr ? nullptr : jacobians[0];
    const double cosine = std::cos(pose[2]);
    const double sine = std::sin(pose[2]);
    for (size_t i = 0; i != point_cloud_.size(); ++i) {
      const double x = point_cloud_[i].position.x();
      const double y = point_cloud_[i].position.y();
      if (jacobian == nullptr) {
        residuals[i] =
            scaling_factor_ *
            CostAtPoint(Eigen::Vector2d((cosine * x - sine * y) + pose[0],
                                        (sine * x + cosine * y) + pose[1]));
      } else {
        EvaluateWithJacobian(pose, cosine, sine, x, y, &residuals[i],
                             jacobian + 3 * i);
      }
    }
    return true;
  }

 private:
  // In the local frame. Rows run along -x, columns along -y.
  double CostAtPoint(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d index =
        (limits_.max() - point) / limits_.resolution();
    double cost, unused_cost_per_row, unused_cost_per_column;
    Interpolate(RoundIndex(index.x() - 0.5), RoundIndex(index.y() - 0.5), &cost,
                &unused_cost_per_row, &unused_cost_per_column);
    return cost;
  }

  void EvaluateWithJacobian(const double* const pose, const double cosine,
                            const double sine, const double x, const double y,
                            double* const residual,
                            double* const jacobian) const {
    const double cells_per_metre = 1. / limits_.resolution();
    const double row =
        (limits_.max().x() - (cosine * x + (-sine * y + pose[0]))) *
            cells_per_metre -
        0.5;
    const double column =
        (limits_.max().y() - (sine * x + (cosine * y + pose[1]))) *
            cells_per_metre -
        0.5;
    double cost, cost_per_row, cost_per_column;
    Interpolate(RoundIndex(row), RoundIndex(column), &cost, &cost_per_row,
                &cost_per_column);
    *residual = scaling_factor_ * cost;
    // Index per radian; the turned point is (-column_turn, row_turn).
    const double row_turn = (sine * x + cosine * y) * cells_per_metre;
    const double column_turn = -(cosine * x - sine * y) * cells_per_metre;
    jacobian[0] = cost_per_row * -cells_per_metre * scaling_factor_;
    jacobian[1] = cost_per_column * -cells_per_metre * scaling_factor_;
    jacobian[2] = (cost_per_row * row_turn + cost_per_column * column_turn) *
                  scaling_factor_;
  }

  // Value and derivatives at a fractional index.
  void Interpolate(const double row, const double column, double* const cost,
                   double* const cost_per_row,
                   double* const cost_per_column) const {
    const int num_rows = limits_.cell_limits().num_y_cells;
    const int num_columns = limits_.cell_limits().num_x_cells;
    // Not inside the grid by any of the 16 cells; also catches NaN and numbers
    // that do not fit an integer.
    if (!(row >= -2. && row < num_rows + 1. && column >= -2. &&
          column < num_columns + 1.)) {
      *cost = kMaxCorrespondenceCost;
      *cost_per_row = 0.;
      *cost_per_column = 0.;
      return;
    }
    const double row_floor = std::floor(row);
    const double column_floor = std::floor(column);
    const int first_row = static_cast<int>(row_floor) - 1;
    const int first_column = static_cast<int>(column_floor) - 1;
    const double row_fraction = row - row_floor;
    const double column_fraction = column - column_floor;

    const bool all_inside = first_row >= 0 && first_row + 3 < num_rows &&
                            first_column >= 0 && first_column + 3 < num_columns;
    double values[4];
    double slopes[4];
    for (int r = 0; r != 4; ++r) {
      double line[4];
      if (all_inside) {
        uint16 buffer[4];
        const uint16* const cells =
            grid_.CellRun(first_column, first_row + r, 4, buffer);
        for (int c = 0; c != 4; ++c) line[c] = value_to_cost_[cells[c]];
      } else {
        for (int c = 0; c != 4; ++c) {
          line[c] = CostAt(first_row + r, first_column + c);
        }
      }
      const Cubic cubic(line[0], line[1], line[2], line[3]);
      values[r] = cubic.Value(column_fraction);
      slopes[r] = cubic.Slope(column_fraction);
    }
    const Cubic by_row(values[0], values[1], values[2], values[3]);
    *cost = by_row.Value(row_fraction);
    *cost_per_row = by_row.Slope(row_fraction);
    *cost_per_column =
        Cubic(slopes[0], slopes[1], slopes[2], slopes[3]).Value(row_fraction);
  }

  double CostAt(const int row, const int column) const {
    if (!limits_.Contains({column, row})) return kMaxCorrespondenceCost;
    return value_to_cost_[grid_.CellValue({column, row})];
  }

  const double scaling_factor_;
  const sensor::PointCloud& point_cloud_;
  const MapLimits& limits_;
  const Grid2D& grid_;
  const float* const value_to_cost_;
};

}  // namespace

ceres::CostFunction* CreateOccupiedSpaceCostFunction2D(
    const double scaling_factor, const sensor::PointCloud& point_cloud,
    const Grid2D& grid) {
  return new OccupiedSpaceCostFunction2D(scaling_factor, point_cloud, grid);
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
