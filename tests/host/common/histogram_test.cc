// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/histogram.h"

#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

TEST(HistogramTest, Empty) { EXPECT_EQ(Histogram().ToString(5), "Count: 0"); }

TEST(HistogramTest, OneValueHasNoBuckets) {
  Histogram histogram;
  histogram.Add(2.f);
  histogram.Add(2.f);
  EXPECT_EQ(histogram.ToString(5),
            "Count: 2  Min: 2.000000  Max: 2.000000  Mean: 2.000000");
}

TEST(HistogramTest, Buckets) {
  Histogram histogram;
  for (const float value : {0.f, 1.f, 1.5f, 4.f}) histogram.Add(value);
  EXPECT_EQ(
      histogram.ToString(2),
      "Count: 4  Min: 0.000000  Max: 4.000000  Mean: 1.625000\n"
      "[0.000000, 2.000000)      ############### Count: 3 (75.00%) Total: 3 "
      "(75.00%)\n"
      "[2.000000, 4.000000]                ##### Count: 1 (25.00%) Total: 4 "
      "(100.00%)");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
