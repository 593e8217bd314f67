// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_fault.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

TEST(SeeTheSameTest, OverAQuarterMetreAndLessThanHalfANarrowView) {
  EXPECT_TRUE(SeeTheSame(Pose2(0.1, -0.2, 0.39)));
  EXPECT_FALSE(SeeTheSame(Pose2(0.2, -0.2, 0.)));
  EXPECT_FALSE(SeeTheSame(Pose2(0., 0., -0.41)));
  EXPECT_TRUE(SeeTheSame(Pose2(0., 0., 2. * kPi - 0.1)));
}

TEST(IsOnePlaceTest, ComparesWithWhatIsExpected) {
  const Pose2 expected(3., -2., 3.1);
  EXPECT_TRUE(IsOnePlace(Pose2(3.15, -1.85, -3.1), expected));
  EXPECT_FALSE(IsOnePlace(Pose2(3.2, -1.8, 3.1), expected));
  EXPECT_FALSE(IsOnePlace(Pose2(3., -2., 2.85), expected));
}

TEST(FaultCostTest, GrowsWithTheErrorRelativeToTheMotion) {
  EXPECT_EQ(FaultCost(Pose2(), Pose2(0.1, 0., 0.1)), 0.);
  // 0.25 m of 0.05 + 0.2 m, and 0.25 rad of 0.05 + 0.2 rad.
  EXPECT_NEAR(FaultCost(Pose2(0.15, -0.2, 0.), Pose2(0., 0.2, 0.)),
              2. * std::log(2.), 1e-12);
  EXPECT_NEAR(FaultCost(Pose2(0., 0., -0.25), Pose2(0., 0., 0.2)),
              2. * std::log(2.), 1e-12);
  EXPECT_NEAR(FaultCost(Pose2(0.15, 0.2, 0.25), Pose2(0.2, 0., -0.2)),
              2. * std::log(3.), 1e-12);
  // Twice the motion, as with the wrong sign, is no surprise; ten metres are,
  // but not an impossible one.
  EXPECT_LT(FaultCost(Pose2(2., 0., 0.), Pose2(1., 0., 0.)), 3.2);
  EXPECT_GT(FaultCost(Pose2(10., 0., 0.), Pose2(0.1, 0., 0.)), 16.);
  EXPECT_LT(FaultCost(Pose2(10., 0., 0.), Pose2(0.1, 0., 0.)), 18.);
}

TEST(BeyondTest, IsAsFarOnTheOtherSide) {
  const Pose2 a(1., 2., 0.5 * kPi);
  const Pose2 b = a * Pose2(0.4, 0.3, 0.2);
  const Pose2 beyond = Beyond(a, b);
  const Pose2 off = Between(b, beyond);
  EXPECT_NEAR(off.x, 0.4, 1e-12);
  EXPECT_NEAR(off.y, 0.3, 1e-12);
  EXPECT_NEAR(off.theta, 0.2, 1e-12);
}

TEST(BeyondTest, IsAnotherPlace) {
  // 0.02 m is a fifth of a place, so ten times as far.
  EXPECT_NEAR(Beyond(Pose2(), Pose2(0.02, 0., 0.)).x, 0.22, 1e-12);
  EXPECT_NEAR(Beyond(Pose2(), Pose2(0., 0., -0.01)).theta, -0.11, 1e-12);
  EXPECT_EQ(Beyond(Pose2(1., 2., 3.), Pose2(1., 2., 3.)).x, 1.);
}

TEST(LogPlacesTest, CountsThePlacesInTheWindow) {
  EXPECT_EQ(LogPlaces(0., 0.), 0.);
  EXPECT_EQ(LogPlaces(0.03, 0.02), 0.);
  // 6 by 6 by 8.
  EXPECT_NEAR(LogPlaces(0.3, 0.2), std::log(288.), 1e-12);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
