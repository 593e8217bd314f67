// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/occupied_space_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ceres/cubic_interpolation.h"
#include "gtest/gtest.h"
#include "tests/scan_matching/test_cells.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

using Cost = OccupiedSpaceCost<TestCells>;

// What Ceres' interpolator asks for; outside as the stock matcher has it.
struct CeresGrid {
  enum { DATA_DIMENSION = 1 };
  explicit CeresGrid(const TestCells* const cells_in) : cells(cells_in) {}
  void GetValue(const int row, const int column, double* const value) const {
    const bool inside = row >= 0 && column >= 0 && row < cells->num_rows() &&
                        column < cells->num_columns();
    *value = inside ? cells->Cost(row, column) : 0.9f;
  }
  const TestCells* cells;
};

TestCells RandomCells() {
  TestCells cells(0.05, 1., 0.7, 30, 20, 0.9f);
  Random random(7);
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 20; ++column) {
      cells.Set(row, column, static_cast<float>(random.Uniform(0.1, 0.9)));
    }
  }
  return cells;
}

TEST(OccupiedSpaceCostTest, CellCentresHaveTheCostOfTheCell) {
  const TestCells cells = RandomCells();
  const Cost cost(&cells, {});
  for (int row = 2; row < 28; row += 5) {
    for (int column = 2; column < 18; column += 3) {
      double value, per_x, per_y;
      cost.CostAt(cells.CenterX(row), cells.CenterY(column), &value, &per_x,
                  &per_y);
      EXPECT_NEAR(value, cells.Cost(row, column), 1e-12);
      // Central difference of the spline at a knot.
      EXPECT_NEAR(
          per_x,
          (cells.Cost(row - 1, column) - cells.Cost(row + 1, column)) / 0.1,
          1e-6);
    }
  }
}

// Inside, at the border, and outside.
TEST(OccupiedSpaceCostTest, SameAsTheInterpolatorOfCeres) {
  const TestCells cells = RandomCells();
  const Cost cost(&cells, {});
  const CeresGrid grid(&cells);
  const ceres::BiCubicInterpolator<CeresGrid> interpolator(grid);
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const double x = random.Uniform(-0.8, 1.3), y = random.Uniform(-0.6, 1.);
    double value, per_x, per_y, expected, per_row, per_column;
    cost.CostAt(x, y, &value, &per_x, &per_y);
    interpolator.Evaluate((1. - x) / 0.05 - 0.5, (0.7 - y) / 0.05 - 0.5,
                          &expected, &per_row, &per_column);
    ASSERT_NEAR(value, expected, 1e-9) << x << " " << y;
    ASSERT_NEAR(per_x, -per_row / 0.05, 1e-7);
    ASSERT_NEAR(per_y, -per_column / 0.05, 1e-7);
  }
}

TEST(OccupiedSpaceCostTest, DerivativesAgreeWithDifferences) {
  const TestCells cells = RandomCells();
  Random random(5);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 40; ++i) {
    points.emplace_back(random.Uniform(-0.5, 0.9), random.Uniform(-0.3, 0.7));
  }
  Cost cost(&cells, points);
  const Pose2 pose(0.02, -0.01, 0.3);
  const OccupiedSpaceSums sums = cost.Evaluate(pose);
  const double step = 1e-7;
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector2d& point : points) {
    Cost one(&cells, {point});
    Eigen::Vector3d gradient;
    for (int k = 0; k < 3; ++k) {
      const auto value = [&](const double by) {
        const Pose2 moved(pose.x + (k == 0 ? by : 0.),
                          pose.y + (k == 1 ? by : 0.),
                          pose.theta + (k == 2 ? by : 0.));
        return std::sqrt(one.Evaluate(moved).squares);
      };
      gradient(k) = (value(step) - value(-step)) / (2. * step);
    }
    // Costs of the spline may be below zero in random cells; c grad c and
    // grad c grad c^T do not mind the sign.
    outer += gradient * gradient.transpose();
  }
  EXPECT_NEAR((sums.hessian - outer).norm() / outer.norm(), 0., 1e-5);
  for (int k = 0; k < 3; ++k) {
    const auto value = [&](const double by) {
      return 0.5 * cost.Evaluate(Pose2(pose.x + (k == 0 ? by : 0.),
                                       pose.y + (k == 1 ? by : 0.),
                                       pose.theta + (k == 2 ? by : 0.)))
                       .squares;
    };
    EXPECT_NEAR(sums.gradient(k), (value(step) - value(-step)) / (2. * step),
                1e-5 * sums.gradient.norm());
  }
}

// A wall along x that nobody has seen beyond x = 0.4 and that was hit the less
// the further it is, and points on it that reach further.
class PointsAtLimitTest : public ::testing::Test {
 protected:
  PointsAtLimitTest() : cells_(0.05, 1., 0.7, 30, 20, 0.9f) {
    for (int row = 0; row < 30; ++row) {
      const double x = cells_.CenterX(row);
      for (int column = 0; column < 20; ++column) {
        if (x > 0.4) cells_.Forget(row, column);
      }
      if (x <= 0.4) {
        cells_.Set(row, 10, static_cast<float>(0.1 + 0.5 * std::max(0., x)));
      }
    }
    for (int i = 0; i < 20; ++i) {
      points_.emplace_back(0.1 + 0.02 * i, cells_.CenterY(10) + 0.01);
    }
  }

  // The wall is across `normal` in the frame of the node.
  PointsAtLimit From(const int num_near, const Pose2& initial,
                     const Eigen::Vector2d& normal) const {
    PointsAtLimit at_limit;
    at_limit.initial = initial;
    at_limit.normals.assign(points_.size() - num_near, normal);
    return at_limit;
  }

  TestCells cells_;
  std::vector<Eigen::Vector2d> points_;
};

TEST_F(PointsAtLimitTest, TellWhatIsAcrossTheirWallOnly) {
  Cost near(&cells_, points_);
  const double pull = near.Evaluate(Pose2()).gradient.x();
  EXPECT_GT(pull, 1.);
  Cost limit(&cells_, points_, BestBicubicKernels(),
             From(0, Pose2(), Eigen::Vector2d::UnitY()));
  const OccupiedSpaceSums sums = limit.Evaluate(Pose2());
  EXPECT_NEAR(sums.gradient.x(), 0., 1e-12);
  EXPECT_NEAR(sums.hessian(0, 0), 0., 1e-12);
  EXPECT_GT(sums.gradient.y(), 1.);
  EXPECT_GT(sums.hessian(1, 1), 1.);
  // However far the robot moves along the wall, both sums stay the same.
  for (const double x : {-0.3, 0.1, 0.5}) {
    EXPECT_NEAR(limit.Evaluate(Pose2(x, 0., 0.)).squares, sums.squares, 1e-12);
    EXPECT_NEAR(limit.LinearSquares(Pose2(x, 0., 0.)),
                limit.LinearSquares(Pose2()), 1e-12);
    EXPECT_NE(limit.LinearSquares(Pose2(x, 0.03, 0.)),
              limit.LinearSquares(Pose2()));
  }
  // Without a wall they tell nothing.
  Cost nothing(&cells_, points_, BestBicubicKernels(),
               From(0, Pose2(), Eigen::Vector2d::Zero()));
  EXPECT_NEAR(nothing.Evaluate(Pose2(0.1, 0.1, 0.2)).squares, sums.squares,
              1e-12);
  EXPECT_NEAR(nothing.Evaluate(Pose2()).hessian.norm(), 0., 1e-12);
}

TEST_F(PointsAtLimitTest, TheWallIsThatOfTheInitialPose) {
  // The node looks along y; the wall is across its x.
  const Pose2 initial(0., 0.3, -0.5 * kPi);
  for (Eigen::Vector2d& point : points_) point = initial.Inverse() * point;
  Cost limit(&cells_, points_, BestBicubicKernels(),
             From(0, initial, Eigen::Vector2d::UnitX()));
  const OccupiedSpaceSums sums = limit.Evaluate(initial);
  EXPECT_NEAR(sums.gradient.x(), 0., 1e-9);
  EXPECT_GT(std::abs(sums.gradient.y()), 1.);
}

TEST_F(PointsAtLimitTest, DerivativesAgreeWithDifferences) {
  const Pose2 initial(0.02, -0.01, 0.05);
  Cost limit(&cells_, points_, BestBicubicKernels(),
             From(5, initial, Eigen::Vector2d(0.6, 0.8)));
  const Pose2 pose(0.05, 0.01, 0.07);
  const OccupiedSpaceSums sums = limit.Evaluate(pose);
  const double step = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const auto value = [&](const double by) {
      return 0.5 * limit
                       .Evaluate(Pose2(pose.x + (k == 0 ? by : 0.),
                                       pose.y + (k == 1 ? by : 0.),
                                       pose.theta + (k == 2 ? by : 0.)))
                       .squares;
    };
    EXPECT_NEAR(sums.gradient(k), (value(step) - value(-step)) / (2. * step),
                1e-5 * sums.gradient.norm());
  }
}

TEST_F(PointsAtLimitTest, WhatNobodyHasSeenCostsEvenOddsThere) {
  PointsAtLimit at_limit;
  at_limit.normals.assign(2, Eigen::Vector2d::UnitY());
  Cost beyond(
      &cells_,
      {Eigen::Vector2d(0.675, cells_.CenterY(10)), Eigen::Vector2d(5., 5.)},
      BestBicubicKernels(), at_limit);
  EXPECT_NEAR(beyond.Evaluate(Pose2()).squares, 2. * 0.25, 1e-12);
  EXPECT_NEAR(beyond.LinearSquares(Pose2()), 2. * 0.25, 1e-12);
}

// The kept patches make no difference.
TEST(OccupiedSpaceCostTest, RepeatsWhateverWasAskedBefore) {
  const TestCells cells = RandomCells();
  const std::vector<Eigen::Vector2d> points = {
      {0.1, 0.2}, {-0.3, 0.4}, {0.91, 0.6}, {5., 5.}};
  Cost kept(&cells, points);
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose(random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2),
                     random.Uniform(-1., 1.));
    Cost fresh(&cells, points);
    const OccupiedSpaceSums a = kept.Evaluate(pose);
    const OccupiedSpaceSums b = fresh.Evaluate(pose);
    ASSERT_EQ(a.squares, b.squares);
    ASSERT_EQ(a.gradient, b.gradient);
    ASSERT_EQ(a.hessian, b.hessian);
  }
}

TEST(OccupiedSpaceCostTest, OutsideAndNonsenseCostTheMostAndPullNowhere) {
  const TestCells cells = RandomCells();
  const Cost cost(&cells, {});
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {10., -10., 1e30, -1e30, inf, -inf, nan}) {
    double value, per_x, per_y;
    cost.CostAt(x, 0., &value, &per_x, &per_y);
    EXPECT_EQ(value, 0.9f);
    EXPECT_EQ(per_x, 0.);
    EXPECT_EQ(per_y, 0.);
  }
}

TEST(OccupiedSpaceCostTest, LinearSquaresInterpolateBetweenCentres) {
  TestCells cells(1., 4., 4., 4, 4, 0.5f);
  cells.Set(1, 1, 0.1f);  // centre (2.5, 2.5)
  const Cost cost(&cells, {{0., 0.}});
  EXPECT_NEAR(cost.LinearSquares(Pose2(2.5, 2.5, 0.)), 0.01, 1e-6);
  EXPECT_NEAR(cost.LinearSquares(Pose2(2., 2.5, 0.)), 0.09, 1e-6);
  // A quarter of the way in both: 9/16 of 0.1, 7/16 of 0.5.
  EXPECT_NEAR(cost.LinearSquares(Pose2(2.25, 2.75, 0.)), 0.275 * 0.275, 1e-6);
  EXPECT_NEAR(cost.LinearSquares(Pose2(0.2, 0.2, 0.)), 0.81, 1e-6);
  EXPECT_NEAR(cost.LinearSquares(Pose2(1e9, 0., 0.)), 0.81, 1e-6);
}

}  // namespace
}  // namespace scan_matching
}  // namespace cartographer_ext
