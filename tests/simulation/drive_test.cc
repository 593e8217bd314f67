// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/drive.h"

#include <cmath>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

Drive Plan(const std::string& text, const uint64_t seed = 0) {
  auto world = ParseWorld(text, "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  auto drive = Drive::Plan(*world, seed);
  EXPECT_TRUE(drive.ok()) << drive.status();
  return *std::move(drive);
}

TEST(DriveTest, StandsStillWithoutCommands) {
  const Drive drive = Plan("start 1 2 90");
  EXPECT_EQ(drive.duration(), 0.);
  EXPECT_EQ(drive.length(), 0.);
  EXPECT_EQ(drive.PoseAt(5.).x, 1.);
  EXPECT_EQ(drive.PoseAt(5.).y, 2.);
  EXPECT_DOUBLE_EQ(drive.PoseAt(-5.).theta, kPi / 2.);
}

TEST(DriveTest, StraightLineTakesTheTrapezoidalTime) {
  // 10 m at 1 m/s with 0.5 m/s^2: 2 s up, 2 s down, 8 m at speed in 8 s.
  const Drive drive =
      Plan("robot speed=1 acceleration=0.5\nstart 0 0 0\ngoto 10 0");
  EXPECT_NEAR(drive.duration(), 12., 0.6);
  EXPECT_NEAR(drive.length(), 10., 0.05);
  const MotionState end = drive.At(drive.duration());
  EXPECT_NEAR(end.pose.x, 10., 0.05);
  EXPECT_NEAR(end.pose.y, 0., 1e-9);
  EXPECT_EQ(end.speed, 0.);
  // 1 s after the start: v = a t, s = a t^2 / 2.
  EXPECT_NEAR(drive.At(1.).speed, 0.5, 1e-9);
  EXPECT_NEAR(drive.At(1.).distance, 0.25, 1e-9);
  EXPECT_NEAR(drive.At(5.).speed, 1., 1e-9);
}

TEST(DriveTest, WaitsAndTurns) {
  const Drive drive = Plan("start 0 0 0\nwait 3\nturn 90\nwait 2");
  EXPECT_EQ(drive.length(), 0.);
  EXPECT_EQ(drive.At(2.9).turn_rate, 0.);
  const MotionState end = drive.At(drive.duration());
  EXPECT_NEAR(end.pose.theta, kPi / 2., 3e-3);
  // 90 degrees at 0.8 rad/s and 1.5 rad/s^2 take about 2.5 s.
  EXPECT_NEAR(drive.duration(), 5. + 2.5, 0.3);
}

TEST(DriveTest, ReversesWithoutTurningRound) {
  const Drive drive = Plan("start 0 0 0\ngoto 3 0\nreverse 1 0");
  const MotionState end = drive.At(drive.duration());
  EXPECT_NEAR(end.pose.x, 1., 0.05);
  EXPECT_NEAR(end.pose.theta, 0., 1e-6);
  EXPECT_NEAR(drive.length(), 5., 0.1);
  EXPECT_NEAR(end.distance, 1., 0.05);  // three forwards, two back
}

TEST(DriveTest, HairpinIsTurnedInPlace) {
  const Drive drive = Plan("start 0 0 0\ngoto 4 0\ngoto 1 0");
  const MotionState end = drive.At(drive.duration());
  EXPECT_NEAR(end.pose.x, 1., 0.05);
  EXPECT_NEAR(std::abs(end.pose.theta), kPi, 0.02);
  for (double time = 0.; time < drive.duration(); time += 0.1) {
    EXPECT_NEAR(drive.PoseAt(time).y, 0., 0.05);
  }
}

TEST(DriveTest, RoundsCornersNearTheWay) {
  const Drive drive = Plan("start 0 0 0\ngoto 5 0\ngoto 5 5\ngoto 10 5");
  double worst = 0.;
  for (double time = 0.; time < drive.duration(); time += 0.05) {
    const Eigen::Vector2d at = drive.PoseAt(time).translation();
    const double off = std::min(
        {PointToSegment(at, {Eigen::Vector2d(0., 0.), Eigen::Vector2d(5., 0.)}),
         PointToSegment(at, {Eigen::Vector2d(5., 0.), Eigen::Vector2d(5., 5.)}),
         PointToSegment(at,
                        {Eigen::Vector2d(5., 5.), Eigen::Vector2d(10., 5.)})});
    worst = std::max(worst, off);
  }
  EXPECT_LT(worst, 0.35);
  EXPECT_GT(worst, 0.02);  // not a sharp corner either
}

// Pose, heading, speed and distance belong together: small steps of the pose
// add up to what the rates say.
TEST(DriveTest, IsConsistentWithItsRates) {
  const Drive drive =
      Plan("start 0 0 30\ngoto 3 1\ngoto 4 5\ngoto -1 4\nreverse 0 4");
  const double step = 1e-4;
  for (double time = 0.; time < drive.duration() - step; time += 0.0371) {
    const MotionState a = drive.At(time), b = drive.At(time + step);
    const Pose2 change = Between(a.pose, b.pose);
    ASSERT_NEAR(change.x, a.speed * step, 1e-7);
    ASSERT_NEAR(change.y, 0., 1e-7);
    ASSERT_NEAR(change.theta, a.turn_rate * step, 1e-7);
    ASSERT_NEAR(b.distance - a.distance, a.speed * step, 1e-7);
    ASSERT_NEAR(
        NormalizeAngle(b.heading - b.pose.theta -
                       2. * kPi *
                           std::round((b.heading - b.pose.theta) / (2. * kPi))),
        0., 1e-9);
    ASSERT_NEAR(b.speed - a.speed, a.acceleration * step, 1e-2 * step + 1e-4);
  }
}

TEST(DriveTest, IsContinuousAcrossSteps) {
  const Drive drive = Plan("start 0 0 0\ngoto 3 0\ngoto 3 3");
  for (double time = kDriveStep; time < drive.duration(); time += kDriveStep) {
    const MotionState before = drive.At(time - 1e-9);
    const MotionState after = drive.At(time + 1e-9);
    ASSERT_NEAR((before.pose.translation() - after.pose.translation()).norm(),
                0., 1e-8);
    ASSERT_NEAR(before.speed, after.speed, 1e-7);
    ASSERT_NEAR(before.turn_rate, after.turn_rate, 1e-7);
  }
}

TEST(DriveTest, SeedMovesWaypointsOnlyWithJitter) {
  const std::string way = "start 0 0 0\ngoto 5 0\ngoto 5 5";
  const Drive a = Plan("robot jitter=0.1\n" + way, 1);
  const Drive b = Plan("robot jitter=0.1\n" + way, 2);
  const Pose2 end_a = a.PoseAt(1e3), end_b = b.PoseAt(1e3);
  EXPECT_GT((end_a.translation() - end_b.translation()).norm(), 1e-3);
  EXPECT_LT((end_a.translation() - end_b.translation()).norm(), 0.4);
  EXPECT_EQ(Plan(way, 1).PoseAt(7.).x, Plan(way, 2).PoseAt(7.).x);
}

TEST(DriveTest, ExtremeMotorsArriveToo) {
  for (const std::string robot :
       {"robot speed=10 acceleration=20 turn_rate=20 turn_acceleration=100",
        "robot speed=0.05 acceleration=20 turn_rate=0.05 "
        "turn_acceleration=0.05",
        "robot speed=2 acceleration=0.1 turn_rate=0.5 turn_acceleration=0.5",
        "robot lookahead=5", "robot lookahead=0.1 speed=3"}) {
    const Drive drive =
        Plan(robot +
             "\nstart 0 0 0\nturn 179\nturn -60\ngoto 3 0\ngoto 3 2\n"
             "goto 0 2\nreverse 1 2\nturn 90");
    const Pose2 end = drive.PoseAt(1e9);
    EXPECT_NEAR(end.x, 1., 0.3) << robot;
    EXPECT_NEAR(end.y, 2., 1.) << robot;
    EXPECT_NEAR(end.theta, kPi / 2., 0.01) << robot;
    EXPECT_LT(drive.duration(), 1000.) << robot;
  }
}

TEST(DriveTest, UnreachableInTimeIsAnError) {
  auto world =
      ParseWorld("robot speed=0.01\nstart 0 0 0\ngoto 9000 0", "far.world");
  ASSERT_TRUE(world.ok());
  const auto drive = Drive::Plan(*world, 0);
  ASSERT_FALSE(drive.ok());
  EXPECT_NE(drive.status().message().find("far.world:3"), std::string::npos)
      << drive.status();
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
