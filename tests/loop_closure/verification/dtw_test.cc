// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/dtw.h"

#include <cmath>
#include <limits>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(VariableWindowTest, EquationFour) {
  VariableWindowOptions options;  // 2, 0.3 as in the paper
  options.base = 4.;
  EXPECT_EQ(VariableWindow(options, 0.), 4);
  EXPECT_EQ(VariableWindow(options, -5.), 4);
  // 4 + 2 (1 - exp(-0.3)) = 4.518..., rounds to 5.
  EXPECT_EQ(VariableWindow(options, 1.), 5);
  // 4 + 2 (1 - exp(-0.9)) = 5.187...
  EXPECT_EQ(VariableWindow(options, 3.), 5);
  // 4 + 2 (1 - exp(-1.5)) = 5.554...
  EXPECT_EQ(VariableWindow(options, 5.), 6);
  EXPECT_EQ(VariableWindow(options, 1e9), 6);
  options.base = 0.;
  options.span = 0.;
  EXPECT_EQ(VariableWindow(options, 1.), 1);
}

TEST(DtwTest, IdenticalSequencesScoreOne) {
  // |i - j| as cost: the diagonal is free.
  std::vector<double> cost;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) cost.push_back(0.25 * std::abs(i - j));
  }
  const auto result = DynamicTimeWarping(4, 4, cost, 1.);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->cost, 0.);
  EXPECT_EQ(result->path_length, 4);
  EXPECT_EQ(result->score(), 1.);
}

TEST(DtwTest, HandComputedPath) {
  // Query (0, 1), reference (0, 0.5, 1): cells (0,0)=0, (0,1)=0.5, (1,1)=0.5,
  // (1,2)=0. Best path (0,0)-(0,1)-(1,2) or (0,0)-(1,1)-(1,2): cost 0.5 over 3.
  const std::vector<double> cost = {0., 0.5, 1., 1., 0.5, 0.};
  const auto result = DynamicTimeWarping(2, 3, cost, -1.);
  ASSERT_TRUE(result.has_value());
  EXPECT_DOUBLE_EQ(result->cost, 0.5);
  EXPECT_EQ(result->path_length, 3);
  EXPECT_NEAR(result->score(), 1. - 0.5 / 3., 1e-15);
}

TEST(DtwTest, BandKeepsThePathNearTheDiagonal) {
  // Free only along the border: with a narrow band the diagonal must be paid.
  const std::vector<double> cost = {0., 0., 0., 1., 1., 0., 1., 1., 0.};
  EXPECT_EQ(DynamicTimeWarping(3, 3, cost, -1.)->cost, 0.);
  EXPECT_DOUBLE_EQ(DynamicTimeWarping(3, 3, cost, 0.)->cost, 1.);
}

TEST(DtwTest, BarredCellsAndEmptySequences) {
  EXPECT_FALSE(DynamicTimeWarping(0, 3, {}, -1.).has_value());
  EXPECT_FALSE(DynamicTimeWarping(2, 0, {}, -1.).has_value());
  EXPECT_FALSE(DynamicTimeWarping(1, 1, {kNaN}, -1.).has_value());
  // The middle column is barred for both rows: no way from corner to corner.
  const std::vector<double> barred = {0., kNaN, 0., 0., kNaN, 0.};
  EXPECT_FALSE(DynamicTimeWarping(2, 3, barred, -1.).has_value());
}

TEST(DtwTest, SingleQueryCoversTheReference) {
  const auto result = DynamicTimeWarping(1, 3, {0.1, 0.2, 0.3}, 0.);
  ASSERT_TRUE(result.has_value());
  EXPECT_NEAR(result->cost, 0.6, 1e-15);
  EXPECT_EQ(result->path_length, 3);
}

// Exhaustive recursion as reference.
double Exhaustive(const int rows, const int columns,
                  const std::vector<double>& cost, const int i, const int j) {
  const double here = cost[i * columns + j];
  if (i == 0 && j == 0) return here;
  double best = std::numeric_limits<double>::infinity();
  if (i > 0) best = std::min(best, Exhaustive(rows, columns, cost, i - 1, j));
  if (j > 0) best = std::min(best, Exhaustive(rows, columns, cost, i, j - 1));
  if (i > 0 && j > 0) {
    best = std::min(best, Exhaustive(rows, columns, cost, i - 1, j - 1));
  }
  return best + here;
}

TEST(DtwTest, EqualsExhaustiveSearch) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const int rows = static_cast<int>(random.UniformInt(1, 5));
    const int columns = static_cast<int>(random.UniformInt(1, 5));
    std::vector<double> cost(rows * columns);
    for (double& c : cost) c = random.Uniform();
    const auto result = DynamicTimeWarping(rows, columns, cost, -1.);
    ASSERT_TRUE(result.has_value());
    EXPECT_NEAR(result->cost,
                Exhaustive(rows, columns, cost, rows - 1, columns - 1), 1e-12);
    EXPECT_GE(result->score(), 0.);
    EXPECT_LE(result->score(), 1.);
  }
}

TEST(DtwTest, AsymmetricWarpingSkipsReferenceElements) {
  // Query 0, 1 against reference 0, 0.5, 1.
  const std::vector<double> cost = {0., 0.5, 1., 1., 0.5, 0.};
  const auto warped = AsymmetricTimeWarping(2, 3, cost, -1., 2);
  ASSERT_TRUE(warped.has_value());
  EXPECT_EQ(warped->cost, 0.);
  EXPECT_EQ(warped->path_length, 2);
  EXPECT_EQ(warped->score(), 1.);
  // With advances of one only, the first element begins later.
  EXPECT_EQ(AsymmetricTimeWarping(2, 3, cost, -1., 1)->cost, 0.5);
  // The band counts from the end, where the candidate is.
  EXPECT_EQ(AsymmetricTimeWarping(2, 3, cost, 0., 2)->cost, 0.);
  EXPECT_FALSE(AsymmetricTimeWarping(2, 3, cost, 0., 1).has_value());
}

TEST(DtwTest, AsymmetricWarpingWithoutAWay) {
  const double nan = std::nan("");
  EXPECT_FALSE(AsymmetricTimeWarping(0, 2, {}, -1., 1).has_value());
  EXPECT_FALSE(AsymmetricTimeWarping(1, 2, {0., nan}, -1., 1).has_value());
  EXPECT_EQ(AsymmetricTimeWarping(1, 2, {nan, 0.25}, -1., 1)->cost, 0.25);
  EXPECT_FALSE(
      AsymmetricTimeWarping(2, 2, {nan, nan, 0., 0.}, -1., 1).has_value());
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
