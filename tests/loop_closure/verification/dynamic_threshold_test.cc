// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/dynamic_threshold.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(ScoreWindowTest, MeanAndPopulationVarianceOfTheLastK) {
  ScoreWindow window(3);
  EXPECT_EQ(window.Mean(), 0.);
  window.Add(100.);  // will be forgotten
  window.Add(1.);
  window.Add(2.);
  EXPECT_TRUE(window.full());
  window.Add(6.);
  // C eq. 3: (1 + 2 + 6) / 3 = 3; eq. 2: (4 + 1 + 9) / 3.
  EXPECT_DOUBLE_EQ(window.Mean(), 3.);
  EXPECT_DOUBLE_EQ(window.Variance(), 14. / 3.);
}

TEST(DynamicThresholdTest, EquationOneAsPrinted) {
  DynamicThresholdOptions options;
  options.low = 0.5;
  options.span = 0.2;
  options.base_threshold = 0.5;
  options.direction = ThresholdDirection::kAsPrinted;
  options.sensitivity = 100.;
  EXPECT_DOUBLE_EQ(ThresholdFromVariance(options, 0.), 0.7);
  EXPECT_NEAR(ThresholdFromVariance(options, 0.01), 0.5 + 0.2 * 0.36787944117,
              1e-10);
  EXPECT_NEAR(ThresholdFromVariance(options, 10.), 0.5, 1e-12);
}

TEST(DynamicThresholdTest, StricterWhenUnstable) {
  DynamicThresholdOptions options;
  options.low = 0.5;
  options.span = 0.2;
  options.base_threshold = 0.5;
  options.direction = ThresholdDirection::kStricterWhenUnstable;
  options.sensitivity = 100.;
  EXPECT_DOUBLE_EQ(ThresholdFromVariance(options, 0.), 0.5);
  EXPECT_NEAR(ThresholdFromVariance(options, 0.01), 0.7 - 0.2 * 0.36787944117,
              1e-10);
  double last = 0.;
  for (double variance = 0.; variance < 0.1; variance += 0.001) {
    const double threshold = ThresholdFromVariance(options, variance);
    EXPECT_GT(threshold, last);
    last = threshold;
  }
}

TEST(DynamicThresholdTest, BaseHoldsUntilKScoresExist) {
  DynamicThresholdOptions options;
  options.low = 0.5;
  options.span = 0.2;
  options.base_threshold = 0.5;
  options.window = 2;
  options.base_threshold = 0.61;
  options.direction = ThresholdDirection::kAsPrinted;
  options.sensitivity = 100.;
  DynamicThreshold threshold(options);
  threshold.AddScore(0.8);
  EXPECT_DOUBLE_EQ(threshold.Current(), 0.61);
  EXPECT_EQ(threshold.Variance(), 0.);
  threshold.AddScore(0.6);
  // Mean 0.7, variance (0.01 + 0.01) / 2 = 0.01.
  EXPECT_NEAR(threshold.Variance(), 0.01, 1e-15);
  EXPECT_NEAR(threshold.Current(), 0.5 + 0.2 * std::exp(-1.), 1e-12);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
