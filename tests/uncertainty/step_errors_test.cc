// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/step_errors.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

StepError Heading(const double variance) {
  StepError error;
  error.doubt(2, 2) = variance;
  return error;
}

StepError Bridged(const double variance) {
  StepError error;
  error.bridged = variance * Eigen::Matrix3d::Identity();
  return error;
}

TEST(StepErrorsTest, FindsByTime) {
  StepErrors steps;
  EXPECT_TRUE(steps.At(5).is_usual());
  steps.Add(5, Heading(0.1));
  steps.Add(7, Bridged(0.2));
  EXPECT_EQ(steps.At(5).doubt, Heading(0.1).doubt);
  EXPECT_FALSE(steps.At(5).bridged.has_value());
  EXPECT_EQ(*steps.At(7).bridged, *Bridged(0.2).bridged);
  EXPECT_FALSE(steps.At(5).is_usual() || steps.At(7).is_usual());
  EXPECT_TRUE(steps.At(6).is_usual());
}

TEST(StepErrorsTest, TwoNodesOfOneTimeBothCount) {
  StepErrors steps;
  steps.Add(5, Heading(0.25));
  steps.Add(5, Heading(0.5));
  EXPECT_EQ(steps.At(5).doubt, Heading(0.75).doubt);
  steps.Add(5, Bridged(0.25));
  EXPECT_EQ(*steps.At(5).bridged, *Bridged(0.25).bridged);
  steps.Add(5, Bridged(0.5));
  EXPECT_EQ(*steps.At(5).bridged, *Bridged(0.75).bridged);
}

TEST(StepErrorsTest, ForgetsTheEarliest) {
  StepErrors steps;
  const auto capacity = static_cast<int64_t>(StepErrors::kCapacity);
  for (int64_t time = 0; time <= capacity; ++time) steps.Add(time, Heading(1.));
  EXPECT_TRUE(steps.At(0).is_usual());
  EXPECT_FALSE(steps.At(1).is_usual());
  EXPECT_FALSE(steps.At(capacity).is_usual());
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
