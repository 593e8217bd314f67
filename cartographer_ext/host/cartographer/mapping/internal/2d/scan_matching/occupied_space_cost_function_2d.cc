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

// Points are interpolated together: the same operations on each, in the same
// order, by instructions for several numbers at once.
constexpr int kTogether = 8;

struct PointBlock {
  double cells[4][4][kTogether];  // by row and column around each point
  double row_fraction[kTogether];
  double column_fraction[kTogether];
  double cost[kTogether];
  double cost_per_row[kTogether];
  double cost_per_column[kTogether];
};

inline __attribute__((always_inline)) void InterpolateInline(
    PointBlock* const block) {
  double values[4][kTogether];
  double slopes[4][kTogether];
  for (int r = 0; r != 4; ++r) {
    for (int i = 0; i != kTogether; ++i) {
      const Cubic cubic(block->cells[r][0][i], block->cells[r][1][i],
                        block->cells[r][2][i], block->cells[r][3][i]);
      values[r][i] = cubic.Value(block->column_fraction[i]);
      slopes[r][i] = cubic.Slope(block->column_fraction[i]);
    }
  }
  for (int i = 0; i != kTogether; ++i) {
    const Cubic by_row(values[0][i], values[1][i], values[2][i], values[3][i]);
    block->cost[i] = by_row.Value(block->row_fraction[i]);
    block->cost_per_row[i] = by_row.Slope(block->row_fraction[i]);
    block->cost_per_column[i] =
        Cubic(slopes[0][i], slopes[1][i], slopes[2][i], slopes[3][i])
            .Value(block->row_fraction[i]);
  }
}

void InterpolatePlain(PointBlock* const block) { InterpolateInline(block); }

#if defined(__x86_64__) && defined(__GNUC__)
// Without fused multiply-add, which would round differently.
__attribute__((target("avx2"))) void InterpolateAvx2(PointBlock* const block) {
  InterpolateInline(block);
}

using InterpolateFunction = void (*)(PointBlock*);
InterpolateFunction BestInterpolate() {
  return __builtin_cpu_supports("avx2") ? &InterpolateAvx2 : &InterpolatePlain;
}
#else
using InterpolateFunction = void (*)(PointBlock*);
InterpolateFunction BestInterpolate() { return &InterpolatePlain; }
#endif

class OccupiedSpaceCostFunction2D : public ceres::CostFunction {
 public:
  OccupiedSpaceCostFunction2D(const double scaling_factor,
                              const sensor::PointCloud& point_cloud,
                              const Grid2D& grid)
      : scaling_factor_(scaling_factor),
        point_cloud_(point_cloud),
        limits_(grid.limits()),
        grid_(grid),
        value_to_cost_(grid.value_to_correspondence_cost()),
        interpolate_(BestInterpolate()) {
    set_num_residuals(static_cast<int>(point_cloud.size()));
    mutable_parameter_block_sizes()->push_back(3);
  }

  bool Evaluate(const double* const* const parameters, double* const residuals,
                double** const jacobians) const override {
    const double* const pose = parameters[0];
    const Turn turn{std::cos(pose[2]), std::sin(pose[2])};
    double* const jacobian = jacobians == nullptr ? nullptr : jacobians[0];
    PointBlock block = {};
    for (size_t begin = 0; begin < point_cloud_.size(); begin += kTogether) {
      const size_t count =
          std::min<size_t>(kTogether, point_cloud_.size() - begin);
      bool is_inside[kTogether];
      for (size_t i = 0; i != count; ++i) {
        const Eigen::Vector3f& point = point_cloud_[begin + i].position;
        const Eigen::Vector2d index =
            jacobian == nullptr ? Index(pose, turn, point.x(), point.y())
                                : JetIndex(pose, turn, point.x(), point.y());
        is_inside[i] = TakeCells(RoundIndex(index.x()), RoundIndex(index.y()),
                                 static_cast<int>(i), &block);
      }
      interpolate_(&block);
      for (size_t i = 0; i != count; ++i) {
        if (!is_inside[i]) {
          block.cost[i] = kMaxCorrespondenceCost;
          block.cost_per_row[i] = block.cost_per_column[i] = 0.;
        }
        residuals[begin + i] = scaling_factor_ * block.cost[i];
        if (jacobian == nullptr) continue;
        const Eigen::Vector3f& point = point_cloud_[begin + i].position;
        SetJacobian(turn, point.x(), point.y(), block.cost_per_row[i],
                    block.cost_per_column[i], jacobian + 3 * (begin + i));
      }
    }
    return true;
  }

 private:
  struct Turn {
    double cosine, sine;
  };

  // Of a point in the local frame. Rows run along -x, columns along -y.
  Eigen::Vector2d Index(const double* const pose, const Turn& turn,
                        const double x, const double y) const {
    const Eigen::Vector2d point((turn.cosine * x - turn.sine * y) + pose[0],
                                (turn.sine * x + turn.cosine * y) + pose[1]);
    const Eigen::Vector2d index =
        (limits_.max() - point) / limits_.resolution();
    return {index.x() - 0.5, index.y() - 0.5};
  }

  // The same as Jets round it.
  Eigen::Vector2d JetIndex(const double* const pose, const Turn& turn,
                           const double x, const double y) const {
    const double cells_per_metre = 1. / limits_.resolution();
    return {
        (limits_.max().x() - (turn.cosine * x + (-turn.sine * y + pose[0]))) *
                cells_per_metre -
            0.5,
        (limits_.max().y() - (turn.sine * x + (turn.cosine * y + pose[1]))) *
                cells_per_metre -
            0.5};
  }

  void SetJacobian(const Turn& turn, const double x, const double y,
                   const double cost_per_row, const double cost_per_column,
                   double* const jacobian) const {
    const double cells_per_metre = 1. / limits_.resolution();
    // Index per radian; the turned point is (-column_turn, row_turn).
    const double row_turn = (turn.sine * x + turn.cosine * y) * cells_per_metre;
    const double column_turn =
        -(turn.cosine * x - turn.sine * y) * cells_per_metre;
    jacobian[0] = cost_per_row * -cells_per_metre * scaling_factor_;
    jacobian[1] = cost_per_column * -cells_per_metre * scaling_factor_;
    jacobian[2] = (cost_per_row * row_turn + cost_per_column * column_turn) *
                  scaling_factor_;
  }

  // The cells around point `i` of the block and its fractional index; false if
  // none of them is inside the grid.
  bool TakeCells(const double row, const double column, const int i,
                 PointBlock* const block) const {
    const int num_rows = limits_.cell_limits().num_y_cells;
    const int num_columns = limits_.cell_limits().num_x_cells;
    // Also catches NaN and numbers that do not fit an integer.
    if (!(row >= -2. && row < num_rows + 1. && column >= -2. &&
          column < num_columns + 1.)) {
      return false;
    }
    const int whole_row = Floor(row);
    const int whole_column = Floor(column);
    const int first_row = whole_row - 1;
    const int first_column = whole_column - 1;
    block->row_fraction[i] = row - whole_row;
    block->column_fraction[i] = column - whole_column;
    const bool all_inside = first_row >= 0 && first_row + 3 < num_rows &&
                            first_column >= 0 && first_column + 3 < num_columns;
    for (int r = 0; r != 4; ++r) {
      if (all_inside) {
        uint16 buffer[4];
        const uint16* const cells =
            grid_.CellRun(first_column, first_row + r, 4, buffer);
        for (int c = 0; c != 4; ++c) {
          block->cells[r][c][i] = value_to_cost_[cells[c]];
        }
      } else {
        for (int c = 0; c != 4; ++c) {
          block->cells[r][c][i] = CostAt(first_row + r, first_column + c);
        }
      }
    }
    return true;
  }

  static int Floor(const double x) {
    const int cut = static_cast<int>(x);
    return cut - (x < cut);
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
  const InterpolateFunction interpolate_;
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
