// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/step_doubt.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

Eigen::Matrix3d Diagonal(const double x, const double y, const double theta) {
  return Eigen::Vector3d(x, y, theta).asDiagonal();
}

TEST(StepDoubtTest, AShareOfThePredictionIsLeft) {
  StepDoubt doubt;
  EXPECT_EQ(doubt.Take().doubt.norm(), 0.);
  doubt.Add(Pose2(1., 0., 0.), Diagonal(0.01, 0.02, 0.04), 0., false);
  EXPECT_EQ(doubt.Take().doubt.norm(), 0.);
  doubt.Add(Pose2(1., 0., 0.), Diagonal(0.01, 0.02, 0.04), 0.25, false);
  EXPECT_TRUE(
      doubt.Take().doubt.isApprox(Diagonal(0.0025, 0.005, 0.01), 1e-12));
  EXPECT_EQ(doubt.Take().doubt.norm(), 0.);  // begun anew
}

// In the frame of its end: after a quarter turn x is y.
TEST(StepDoubtTest, IsSeenFromTheEnd) {
  StepDoubt doubt;
  doubt.Add(Pose2(0., 0., 0.5 * kPi), Diagonal(0.01, 0.02, 0.04), 1., false);
  EXPECT_TRUE(doubt.Take().doubt.isApprox(Diagonal(0.02, 0.01, 0.04), 1e-12));
}

// A heading off by some variance at one scan, two metres straight on.
TEST(StepDoubtTest, ErrorsOfScansBetweenNodesAddUp) {
  StepDoubt doubt;
  doubt.Add(Pose2(1., 0., 0.), Diagonal(0., 0., 0.01), 1., false);
  doubt.Add(Pose2(2., 0., 0.), Diagonal(0., 0., 0.01), 0.5, false);
  Eigen::Matrix3d expected;
  expected << 0., 0., 0., 0., 0.04, 0.02, 0., 0.02, 0.015;
  EXPECT_TRUE(doubt.Take().doubt.isApprox(expected, 1e-12));
}

// Where no sensor measured the motion, the match is within its search.
TEST(StepDoubtTest, IsNoLargerThanASearch) {
  StepDoubt doubt;
  Eigen::Matrix3d wide = Diagonal(100., 1., 9.);
  wide(0, 2) = wide(2, 0) = 3.;
  doubt.Add(Pose2(), wide, 1., false);
  const Eigen::Matrix3d bounded = doubt.Take().doubt;
  EXPECT_NEAR(bounded(0, 0), 0.09, 1e-12);
  EXPECT_NEAR(bounded(1, 1), 0.0009, 1e-12);
  EXPECT_NEAR(bounded(2, 2), 0.16, 1e-12);
  // With the correlation of before, a tenth.
  EXPECT_NEAR(bounded(0, 2), 0.1 * 0.3 * 0.4, 1e-12);
}

// A quarter turn after twenty metres without a scan, then a usual one two metres on.
TEST(StepDoubtTest, AGapIsAsWrongAsItsReckoning) {
  StepDoubt doubt;
  EXPECT_FALSE(doubt.Take().bridged.has_value());
  doubt.Add(Pose2(20., 0., 0.5 * kPi), Diagonal(4., 9., 0.01), 1., true);
  doubt.Add(Pose2(2., 0., 0.), Diagonal(0., 0., 0.01), 0., false);
  const uncertainty::StepError error = doubt.Take();
  ASSERT_TRUE(error.bridged.has_value());
  Eigen::Matrix3d expected = Diagonal(9., 4. + 0.04, 0.01);
  expected(1, 2) = expected(2, 1) = 0.02;
  EXPECT_TRUE(error.bridged->isApprox(expected, 1e-12));
  EXPECT_TRUE(error.doubt.isZero(0.));
  EXPECT_TRUE(doubt.Take().is_usual());
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
