// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/pose2.h"

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace {

void ExpectNear(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(NormalizeAngle(a.theta - b.theta), 0., 1e-12);
}

TEST(Pose2Test, Angles) {
  EXPECT_EQ(NormalizeAngle(1.), 1.);
  EXPECT_EQ(NormalizeAngle(kPi), kPi);
  EXPECT_NEAR(NormalizeAngle(1.5 * kPi), -0.5 * kPi, 1e-12);
  EXPECT_NEAR(NormalizeAngle(-7. * kPi / 2.), kPi / 2., 1e-12);
  EXPECT_NEAR(DegToRad(180.), kPi, 1e-15);
  EXPECT_NEAR(RadToDeg(kPi / 2.), 90., 1e-12);
}

TEST(Pose2Test, MovesPoints) {
  // A quarter turn to the left and one metre ahead.
  const Pose2 pose(1., 0., kPi / 2.);
  const Eigen::Vector2d moved = pose * Eigen::Vector2d(2., 0.);
  EXPECT_NEAR(moved.x(), 1., 1e-12);
  EXPECT_NEAR(moved.y(), 2., 1e-12);
  ExpectNear(pose * Pose2(2., 0., kPi), Pose2(1., 2., -kPi / 2.));
}

TEST(Pose2Test, InverseAndBetween) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 a(random.Normal(), random.Normal(), random.Uniform(-3., 3.));
    const Pose2 b(random.Normal(), random.Normal(), random.Uniform(-3., 3.));
    ExpectNear(a * a.Inverse(), Pose2());
    ExpectNear(a.Inverse() * a, Pose2());
    ExpectNear(a * Between(a, b), b);
    const Eigen::Vector2d point(random.Normal(), random.Normal());
    EXPECT_TRUE(((a * b) * point).isApprox(a * (b * point), 1e-12));
  }
}

TEST(Pose2Test, InterpolatesTheShortWay) {
  const Pose2 a(0., 0., 3.), b(1., 2., -3.);
  const Pose2 middle = Interpolate(a, b, 0.5);
  EXPECT_NEAR(middle.x, 0.5, 1e-12);
  EXPECT_NEAR(middle.y, 1., 1e-12);
  EXPECT_NEAR(std::abs(middle.theta), kPi, 1e-12);
  ExpectNear(Interpolate(a, b, 0.), a);
  ExpectNear(Interpolate(a, b, 1.), b);
}

}  // namespace
}  // namespace cartographer_ext
