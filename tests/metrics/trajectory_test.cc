// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/trajectory.h"

#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr io::TimeNs kSecond = 1000000000;
constexpr io::TimeNs kMillisecond = 1000000;

Trajectory QuarterTurn() {
  return Trajectory({{20 * kSecond, ToIsometry(Pose2(4., 2., kPi / 2.))},
                     {10 * kSecond, ToIsometry(Pose2(0., 0., 0.))}});
}

TEST(TrajectoryTest, SortsAndDropsEqualStamps) {
  const Trajectory trajectory({{2, ToIsometry(Pose2(2., 0., 0.))},
                               {1, ToIsometry(Pose2(1., 0., 0.))},
                               {2, ToIsometry(Pose2(9., 0., 0.))}});
  ASSERT_EQ(trajectory.poses().size(), 2u);
  EXPECT_EQ(trajectory.poses()[0].time, 1);
  EXPECT_EQ(trajectory.poses()[1].pose.translation().x(), 2.);
}

TEST(TrajectoryTest, InterpolatesBetweenNeighbours) {
  const auto pose = QuarterTurn().Lookup(15 * kSecond, 0);
  ASSERT_TRUE(pose.has_value());
  const Pose2 planar = ToPose2(*pose);
  EXPECT_NEAR(planar.x, 2., 1e-12);
  EXPECT_NEAR(planar.y, 1., 1e-12);
  EXPECT_NEAR(planar.theta, kPi / 4., 1e-12);
}

TEST(TrajectoryTest, PrefersAStampWithinTheTolerance) {
  const Trajectory trajectory = QuarterTurn();
  const auto near =
      trajectory.Lookup(10 * kSecond + kMillisecond, kMillisecond);
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->translation().x(), 0.);
  const auto further =
      trajectory.Lookup(10 * kSecond + 2 * kMillisecond, kMillisecond);
  ASSERT_TRUE(further.has_value());
  EXPECT_NEAR(further->translation().x(), 4. * 0.002 / 10., 1e-12);
}

TEST(TrajectoryTest, KnowsNothingOutsideItsSpan) {
  const Trajectory trajectory = QuarterTurn();
  EXPECT_FALSE(trajectory.Lookup(9 * kSecond, kMillisecond).has_value());
  EXPECT_FALSE(trajectory.Lookup(21 * kSecond, kMillisecond).has_value());
  EXPECT_TRUE(trajectory.Lookup(10 * kSecond, 0).has_value());
  EXPECT_TRUE(trajectory.Lookup(20 * kSecond, 0).has_value());
  // Just outside, but within the tolerance.
  EXPECT_TRUE(trajectory.Lookup(20 * kSecond + 1, kMillisecond).has_value());
  EXPECT_FALSE(Trajectory().Lookup(0, kMillisecond).has_value());
}

TEST(TrajectoryTest, DistanceToNearestStamp) {
  const Trajectory trajectory = QuarterTurn();
  EXPECT_EQ(trajectory.DistanceToNearestStamp(12 * kSecond), 2 * kSecond);
  EXPECT_EQ(trajectory.DistanceToNearestStamp(19 * kSecond), 1 * kSecond);
  EXPECT_EQ(trajectory.DistanceToNearestStamp(5 * kSecond), 5 * kSecond);
  EXPECT_EQ(trajectory.DistanceToNearestStamp(25 * kSecond), 5 * kSecond);
  EXPECT_EQ(Trajectory().DistanceToNearestStamp(0),
            std::numeric_limits<io::TimeNs>::max());
}

TEST(TrajectoryTest, LengthSumsTheSteps) {
  const Trajectory trajectory({{1, ToIsometry(Pose2(0., 0., 0.))},
                               {2, ToIsometry(Pose2(3., 4., 1.))},
                               {3, ToIsometry(Pose2(3., 5., 2.))}});
  EXPECT_DOUBLE_EQ(trajectory.Length(), 6.);
}

TEST(TrajectoryTest, PlanarPoseSurvivesTheRoundTrip) {
  for (const double theta : {-3.1, -1., 0., 1e-9, 2.5, 3.14}) {
    const Pose2 pose = ToPose2(ToIsometry(Pose2(1., -2., theta)));
    EXPECT_DOUBLE_EQ(pose.x, 1.);
    EXPECT_DOUBLE_EQ(pose.y, -2.);
    EXPECT_NEAR(pose.theta, theta, 1e-15);
  }
}

TEST(TrajectoryTest, RotationAngleIsAccurateForSmallAndLargeAngles) {
  EXPECT_NEAR(RotationAngle(ToIsometry(Pose2(0., 0., 1e-7))), 1e-7, 1e-15);
  EXPECT_NEAR(RotationAngle(ToIsometry(Pose2(0., 0., -2.5))), 2.5, 1e-12);
  EXPECT_NEAR(RotationAngle(ToIsometry(Pose2(0., 0., kPi))), kPi, 1e-7);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
