// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/statistics.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(StatisticsTest, EmptyListGivesZeros) {
  const Statistics statistics = ComputeStatistics({});
  EXPECT_EQ(statistics.count, 0);
  EXPECT_EQ(statistics.mean, 0.);
  EXPECT_EQ(statistics.std, 0.);
  EXPECT_EQ(statistics.median, 0.);
  EXPECT_EQ(statistics.rmse, 0.);
  EXPECT_EQ(statistics.max, 0.);
}

TEST(StatisticsTest, OneValueHasNoSpread) {
  const Statistics statistics = ComputeStatistics({3.});
  EXPECT_EQ(statistics.count, 1);
  EXPECT_EQ(statistics.mean, 3.);
  EXPECT_EQ(statistics.std, 0.);
  EXPECT_EQ(statistics.median, 3.);
  EXPECT_EQ(statistics.rmse, 3.);
}

TEST(StatisticsTest, UsesTheSampleDeviationAndTheMiddleValue) {
  // Deviations from 5: 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32, divided by 7.
  const Statistics statistics =
      ComputeStatistics({9., 2., 4., 4., 4., 5., 5., 7.});
  EXPECT_EQ(statistics.count, 8);
  EXPECT_DOUBLE_EQ(statistics.mean, 5.);
  EXPECT_DOUBLE_EQ(statistics.std, std::sqrt(32. / 7.));
  EXPECT_DOUBLE_EQ(statistics.median, 4.5);
  EXPECT_DOUBLE_EQ(statistics.rmse, std::sqrt(232. / 8.));
  EXPECT_DOUBLE_EQ(statistics.max, 9.);
}

TEST(StatisticsTest, SpreadSurvivesALargeOffset) {
  const Statistics statistics = ComputeStatistics({1e9 + 1., 1e9 + 2.});
  EXPECT_NEAR(statistics.std, std::sqrt(0.5), 1e-6);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
