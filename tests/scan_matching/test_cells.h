// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Grids and scans for the tests of scan matching that need no host.
#ifndef TESTS_SCAN_MATCHING_TEST_CELLS_H_
#define TESTS_SCAN_MATCHING_TEST_CELLS_H_

#include <cmath>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace scan_matching {

// A grid in memory as occupied_space_cost.h wants it; its largest corner is
// (max_x, max_y).
class TestCells {
 public:
  TestCells(const double resolution, const double max_x, const double max_y,
            const int num_rows, const int num_columns, const float cost)
      : resolution_(resolution),
        max_x_(max_x),
        max_y_(max_y),
        num_rows_(num_rows),
        num_columns_(num_columns),
        costs_(static_cast<size_t>(num_rows) * num_columns, cost) {}

  double resolution() const { return resolution_; }
  double max_x() const { return max_x_; }
  double max_y() const { return max_y_; }
  int num_rows() const { return num_rows_; }
  int num_columns() const { return num_columns_; }
  bool IsKnown(const int row, const int column) const {
    return unknown_.count({row, column}) == 0;
  }
  void Forget(const int row, const int column) {
    unknown_.insert({row, column});
  }
  float Cost(const int row, const int column) const {
    return costs_[static_cast<size_t>(row) * num_columns_ + column];
  }
  void CopyCosts(const int row, const int column, const int count,
                 float* const costs) const {
    for (int i = 0; i != count; ++i) costs[i] = Cost(row, column + i);
  }
  void Set(const int row, const int column, const float cost) {
    costs_[static_cast<size_t>(row) * num_columns_ + column] = cost;
  }
  double CenterX(const int row) const {
    return max_x_ - resolution_ * (row + 0.5);
  }
  double CenterY(const int column) const {
    return max_y_ - resolution_ * (column + 0.5);
  }

  // Costs by the distance (metres) from the nearest wall: 0.1 on it, 0.9 from
  // three cells on; with a little noise.
  void Draw(const std::function<double(double, double)>& distance,
            const double noise, Random* const random) {
    for (int row = 0; row < num_rows_; ++row) {
      for (int column = 0; column < num_columns_; ++column) {
        const double d = distance(CenterX(row), CenterY(column)) / resolution_;
        double cost = 0.9 - 0.8 * std::exp(-0.5 * d * d);
        cost += noise * random->Normal();
        Set(row, column,
            static_cast<float>(std::fmin(0.9, std::fmax(0.1, cost))));
      }
    }
  }

 private:
  const double resolution_, max_x_, max_y_;
  const int num_rows_, num_columns_;
  std::vector<float> costs_;
  std::set<std::pair<int, int>> unknown_;  // row, column
};

// 8 m by 8 m around the origin, cells of 5 cm.
inline TestCells EmptyCells() {
  return TestCells(0.05, 4., 4., 160, 160, 0.9f);
}

// The points as a node at `pose` sees them.
inline std::vector<Eigen::Vector2d> SeenFrom(
    const Pose2& pose, std::vector<Eigen::Vector2d> points) {
  const Pose2 inverse = pose.Inverse();
  for (Eigen::Vector2d& point : points) point = inverse * point;
  return points;
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // TESTS_SCAN_MATCHING_TEST_CELLS_H_
