// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/insertion_count.h"

#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

TEST(InsertionCountTest, OneForEveryScanThatTheMotionFilterWouldHaveLetPass) {
  EXPECT_EQ(InsertionCount(Pose2(), 0.2), 1);
  EXPECT_EQ(InsertionCount(Pose2(0.39, 0., 0.), 0.2), 1);
  EXPECT_EQ(InsertionCount(Pose2(0., -0.41, 0.), 0.2), 2);
  EXPECT_EQ(InsertionCount(Pose2(0.6, 0.81, 0.), 0.2), 5);
}

TEST(InsertionCountTest, RotationCountsToo) {
  EXPECT_EQ(InsertionCount(Pose2(0., 0., 0.19), 0.2), 1);
  EXPECT_EQ(InsertionCount(Pose2(0., 0., -0.51), 0.2), 5);
  EXPECT_EQ(InsertionCount(Pose2(0., 0., 2. * kPi - 0.31), 0.2), 3);
  // Not on top of the translation.
  EXPECT_EQ(InsertionCount(Pose2(0.61, 0., 0.51), 0.2), 5);
}

TEST(InsertionCountTest, OneScanDoesNotStandForAGap) {
  EXPECT_EQ(InsertionCount(Pose2(300., 0., 0.), 0.2), 10);
  EXPECT_EQ(InsertionCount(Pose2(1e300, 0., 3.), 1e-300), 10);
}

TEST(InsertionCountTest, WithoutASpacingEveryScanStandsForItself) {
  EXPECT_EQ(InsertionCount(Pose2(5., 0., 0.), 0.), 1);
  EXPECT_EQ(InsertionCount(Pose2(5., 0., 0.), -1.), 1);
  EXPECT_EQ(InsertionCount(Pose2(5., 0., 0.),
                           std::numeric_limits<double>::quiet_NaN()),
            1);
  EXPECT_EQ(InsertionCount(
                Pose2(std::numeric_limits<double>::quiet_NaN(), 0., 0.), 0.2),
            1);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
