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

// Weights of four equidistant samples, and of the derivative, for a position t
// in [0, 1) between the middle two: the Catmull-Rom spline, which is what
// ceres::BiCubicInterpolator uses as well.
struct CubicWeights {
  explicit CubicWeights(const double t) {
    const double t2 = t * t;
    const double t3 = t2 * t;
    value[0] = 0.5 * (-t3 + 2. * t2 - t);
    value[1] = 0.5 * (3. * t3 - 5. * t2 + 2.);
    value[2] = 0.5 * (-3. * t3 + 4. * t2 + t);
    value[3] = 0.5 * (t3 - t2);
    slope[0] = 0.5 * (-3. * t2 + 4. * t - 1.);
    slope[1] = 0.5 * (9. * t2 - 10. * t);
    slope[2] = 0.5 * (-9. * t2 + 8. * t + 1.);
    slope[3] = 0.5 * (3. * t2 - 2. * t);
  }
  double value[4];
  double slope[4];
};

class OccupiedSpaceCostFunction2D : public ceres::CostFunction {
 public:
  OccupiedSpaceCostFunction2D(const double scaling_factor,
                              const sensor::PointCloud& point_cloud,
                              const Grid2D& grid)
      : scaling_factor_(scaling_factor),
        point_cloud_(point_cloud),
        limits_(grid.limits()),
        cells_(grid.cell_values()),
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
    const double cells_per_metre = 1. / limits_.resolution();
    const double gradient_scale = -scaling_factor_ * cells_per_metre;
    for (size_t i = 0; i != point_cloud_.size(); ++i) {
      const Eigen::Vector3f& point = point_cloud_[i].position;
      // The point turned into the grid's axes, relative to the pose.
      const double x = cosine * point.x() - sine * point.y();
      const double y = sine * point.x() + cosine * point.y();
      // Fractional index: rows run along -x, columns along -y.
      const double row =
          (limits_.max().x() - (pose[0] + x)) * cells_per_metre - 0.5;
      const double column =
          (limits_.max().y() - (pose[1] + y)) * cells_per_metre - 0.5;
      double cost, cost_per_row, cost_per_column;
      Interpolate(row, column, &cost, &cost_per_row, &cost_per_column);
      residuals[i] = scaling_factor_ * cost;
      if (jacobian != nullptr) {
        const double by_x = gradient_scale * cost_per_row;
        const double by_y = gradient_scale * cost_per_column;
        jacobian[3 * i] = by_x;
        jacobian[3 * i + 1] = by_y;
        jacobian[3 * i + 2] = by_y * x - by_x * y;
      }
    }
    return true;
  }

 private:
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
    const CubicWeights by_row(row - row_floor);
    const CubicWeights by_column(column - column_floor);

    const bool all_inside = first_row >= 0 && first_row + 3 < num_rows &&
                            first_column >= 0 && first_column + 3 < num_columns;
    double sum = 0.;
    double row_sum = 0.;
    double column_sum = 0.;
    for (int r = 0; r != 4; ++r) {
      double line[4];
      if (all_inside) {
        const uint16* const cells =
            cells_ + num_columns * (first_row + r) + first_column;
        for (int c = 0; c != 4; ++c) line[c] = value_to_cost_[cells[c]];
      } else {
        for (int c = 0; c != 4; ++c) {
          line[c] = CostAt(first_row + r, first_column + c);
        }
      }
      double value = 0.;
      double slope = 0.;
      for (int c = 0; c != 4; ++c) {
        value += by_column.value[c] * line[c];
        slope += by_column.slope[c] * line[c];
      }
      sum += by_row.value[r] * value;
      row_sum += by_row.slope[r] * value;
      column_sum += by_row.value[r] * slope;
    }
    *cost = sum;
    *cost_per_row = row_sum;
    *cost_per_column = column_sum;
  }

  double CostAt(const int row, const int column) const {
    if (!limits_.Contains({column, row})) return kMaxCorrespondenceCost;
    return value_to_cost_[cells_[limits_.cell_limits().num_x_cells * row +
                                 column]];
  }

  const double scaling_factor_;
  const sensor::PointCloud& point_cloud_;
  const MapLimits& limits_;
  const uint16* const cells_;
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
