// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/live_robot.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

LiveRobotOptions NoSlip() {
  LiveRobotOptions options;
  options.slip_sigma = options.burst_rate = 0.;
  return options;
}

void Drive(const double seconds, LiveRobot* const robot) {
  for (int i = 0; i != std::lround(seconds / 0.01); ++i) robot->Advance(0.01);
}

TEST(LiveRobotTest, FollowsACommandAfterItsDelayWithItsLimits) {
  const RobotLimits limits;
  LiveRobot robot(simulation::World(), limits, NoSlip(), Pose2(), 1);
  robot.Command({0.6, 0.});
  Drive(0.09, &robot);
  EXPECT_EQ(robot.velocity().linear, 0.);
  Drive(0.51, &robot);
  EXPECT_NEAR(robot.velocity().linear, 0.5 * limits.acceleration, 0.011);
  Drive(1.4, &robot);
  EXPECT_NEAR(robot.velocity().linear, 0.6, 1e-9);
  const double before = robot.pose().x;
  robot.Command({0., 0.});
  Drive(2., &robot);
  EXPECT_EQ(robot.velocity().linear, 0.);
  EXPECT_NEAR(robot.pose().x - before,
              0.6 * 0.1 + 0.6 * 0.6 / (2. * limits.deceleration), 0.01);
}

TEST(LiveRobotTest, PerfectOdometryIsTheTruth) {
  LiveRobot robot(simulation::World(), RobotLimits(), NoSlip(),
                  Pose2(1., 2., 0.5), 1);
  robot.Command({0.5, 0.4});
  Drive(5., &robot);
  const Pose2 moved = Between(Pose2(1., 2., 0.5), robot.pose());
  EXPECT_NEAR(moved.x, robot.odometry().x, 1e-9);
  EXPECT_NEAR(moved.y, robot.odometry().y, 1e-9);
  EXPECT_GT(robot.travelled(), 2.);
}

TEST(LiveRobotTest, SlipIsNotSeenByTheOdometry) {
  LiveRobotOptions options;
  options.slip_sigma = 0.03;
  LiveRobot robot(simulation::World(), RobotLimits(), options, Pose2(), 5);
  robot.Command({0.5, 0.});
  Drive(20., &robot);
  EXPECT_LT(robot.travelled(), robot.odometry().x);
  EXPECT_GT(robot.travelled(), 0.8 * robot.odometry().x);
}

TEST(LiveRobotTest, TheSeedDecides) {
  simulation::World world;
  world.odometry.noise = 0.004;
  const auto end = [&](const uint64_t seed) {
    LiveRobot robot(world, RobotLimits(), LiveRobotOptions(), Pose2(), seed);
    robot.Command({0.5, 0.1});
    Drive(10., &robot);
    return robot.odometry();
  };
  EXPECT_EQ(end(1).x, end(1).x);
  EXPECT_NE(end(1).x, end(2).x);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
