// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/order_statistics.h"

#include <algorithm>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

TEST(OrderStatisticsTest, TheMedianIsOneOfTheValues) {
  EXPECT_EQ(UpperMedian<int>({7}), 7);
  EXPECT_EQ(UpperMedian<int>({9, 1, 4}), 4);
  // An even number: the larger one of the middle two, not their mean.
  EXPECT_EQ(UpperMedian<double>({4., 1.}), 4.);
  EXPECT_EQ(UpperMedian<double>({8., 1., 2., 4.}), 4.);
}

TEST(OrderStatisticsTest, QuantilesAreByNearestRank) {
  const std::vector<double> values = {3., 1., 4., 2.};
  EXPECT_EQ(NearestRankQuantile(values, 0.), 1.);
  EXPECT_EQ(NearestRankQuantile(values, 0.25), 1.);
  EXPECT_EQ(NearestRankQuantile(values, 0.26), 2.);
  EXPECT_EQ(NearestRankQuantile(values, 0.5), 2.);
  EXPECT_EQ(NearestRankQuantile(values, 0.99), 4.);
  EXPECT_EQ(NearestRankQuantile(values, 1.), 4.);
}

TEST(OrderStatisticsTest, AgreesWithSorting) {
  Random random(7);
  for (size_t count = 1; count != 40; ++count) {
    std::vector<double> values(count);
    for (double& value : values) value = std::floor(10. * random.Uniform());
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (size_t rank = 0; rank != count; ++rank) {
      EXPECT_EQ(OrderStatistic(values, rank), sorted[rank]);
    }
    EXPECT_EQ(UpperMedian(values), sorted[count / 2]);
  }
}

TEST(OrderStatisticsDeathTest, NoValuesHaveNoMedian) {
  EXPECT_DEATH(UpperMedian<double>({}), "Check failed");
  EXPECT_DEATH(NearestRankQuantile<double>({}, 0.5), "Check failed");
}

}  // namespace
}  // namespace cartographer_ext
