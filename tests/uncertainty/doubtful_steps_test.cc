// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/doubtful_steps.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

Eigen::Matrix3d Heading(const double variance) {
  return Eigen::Vector3d(0., 0., variance).asDiagonal();
}

TEST(DoubtfulStepsTest, FindsByTime) {
  DoubtfulSteps steps;
  EXPECT_EQ(steps.CovarianceAt(5).norm(), 0.);
  steps.Add(5, Heading(0.1));
  steps.Add(7, Heading(0.2));
  EXPECT_EQ(steps.CovarianceAt(5), Heading(0.1));
  EXPECT_EQ(steps.CovarianceAt(7), Heading(0.2));
  EXPECT_EQ(steps.CovarianceAt(6).norm(), 0.);
}

TEST(DoubtfulStepsTest, TwoNodesOfOneTimeBothCount) {
  DoubtfulSteps steps;
  steps.Add(5, Heading(0.25));
  steps.Add(5, Heading(0.5));
  EXPECT_EQ(steps.CovarianceAt(5), Heading(0.75));
}

TEST(DoubtfulStepsTest, ForgetsTheEarliest) {
  DoubtfulSteps steps;
  const auto capacity = static_cast<int64_t>(DoubtfulSteps::kCapacity);
  for (int64_t time = 0; time <= capacity; ++time) steps.Add(time, Heading(1.));
  EXPECT_EQ(steps.CovarianceAt(0).norm(), 0.);
  EXPECT_EQ(steps.CovarianceAt(1), Heading(1.));
  EXPECT_EQ(steps.CovarianceAt(capacity), Heading(1.));
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
