// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/speed_limiter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kMargin = 0.02;

// Least distance from the outline to an echo.
double Gap(const std::vector<Eigen::Vector2d>& echoes,
           const Footprint& footprint, const Pose2& pose) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Footprint::Part& part : footprint.parts) {
    for (const Eigen::Vector2d& echo : echoes) {
      gap = std::min(gap, (echo - pose * part.center).norm() - part.radius);
    }
  }
  return gap;
}

TEST(SpeedLimiterTest, SafeSpeedStopsWithinTheDistance) {
  for (const double distance : {0.01, 0.1, 0.5, 2., 10.}) {
    for (const double reaction : {0., 0.2, 0.5}) {
      const double v = SafeSpeed(distance, reaction, 0.8);
      EXPECT_NEAR(v * reaction + v * v / 1.6, distance, 1e-9);
    }
  }
  EXPECT_EQ(SafeSpeed(0., 0.2, 0.8), 0.);
  EXPECT_EQ(SafeSpeed(-1., 0.2, 0.8), 0.);
  EXPECT_EQ(SafeSpeed(std::nan(""), 0.2, 0.8), 0.);
  // Eq. 14 of the dynamic window approach.
  EXPECT_NEAR(SafeSpeed(1., 0., 0.5), std::sqrt(2. * 1. * 0.5), 1e-12);
}

TEST(SpeedLimiterTest, StopsBeforeEveryEcho) {
  // Whatever is commanded and wherever echoes are: going on for the reaction
  // time and braking then never touches one.
  Random random(11);
  int limited = 0, stopped = 0, touched_without = 0;
  for (int trial = 0; trial != 2000; ++trial) {
    RobotLimits robot;
    robot.footprint = trial % 2 == 0 ? Footprint::Disc(0.25)
                                     : Footprint::Rectangle(0.4, 0.2, 0.25);
    robot.deceleration = random.Uniform(0.3, 1.5);
    robot.reaction_seconds = random.Uniform(0.05, 0.5);
    std::vector<Eigen::Vector2d> echoes;
    const int count = random.UniformInt(0, 8);
    while (static_cast<int>(echoes.size()) < count) {
      const Eigen::Vector2d echo(random.Uniform(-2., 2.),
                                 random.Uniform(-2., 2.));
      if (Gap({echo}, robot.footprint, Pose2()) > 0.01) echoes.push_back(echo);
    }
    Velocity wish{random.Uniform(-1., 1.), random.Uniform(-1.5, 1.5)};
    if (std::abs(wish.linear) < 0.01) wish.linear = 0.01;
    const Velocity command = LimitSpeed(echoes, robot, kMargin, wish);
    // The same arc, not faster.
    EXPECT_LE(std::abs(command.linear), std::abs(wish.linear) + 1e-12);
    EXPECT_NEAR(command.linear * wish.angular, command.angular * wish.linear,
                1e-9);
    limited += command.linear != wish.linear;
    stopped += command.linear == 0.;
    const auto least_gap = [&](const Velocity& driven) {
      const double seconds = std::abs(driven.linear) / robot.deceleration;
      const double effective = robot.reaction_seconds + 0.5 * seconds;
      double gap = std::numeric_limits<double>::infinity();
      for (double share = 0.; share <= 1.; share += 0.01) {
        gap = std::min(gap, Gap(echoes, robot.footprint,
                                ArcPose(share * effective * driven.linear,
                                        share * effective * driven.angular)));
      }
      return gap;
    };
    // Half a step of the arc is the tolerance.
    EXPECT_GT(least_gap(command), 0.) << "trial " << trial;
    touched_without += least_gap(wish) <= 0.;
  }
  EXPECT_GT(touched_without, 70);
  EXPECT_GT(limited, touched_without);
  EXPECT_LT(stopped, 1500);
}

TEST(SpeedLimiterTest, MayLeaveWhatItTouches) {
  const RobotLimits robot;
  const std::vector<Eigen::Vector2d> ahead = {{0.255, 0.}};
  EXPECT_EQ(LimitSpeed(ahead, robot, kMargin, {0.3, 0.}).linear, 0.);
  EXPECT_EQ(LimitSpeed(ahead, robot, kMargin, {-0.1, 0.}).linear, -0.1);
}

TEST(SpeedLimiterTest, TurnsOnTheSpotOnlyWhereTheOutlineIsFree) {
  RobotLimits robot;
  const std::vector<Eigen::Vector2d> beside = {{0.35, 0.33}};
  EXPECT_EQ(LimitSpeed(beside, robot, kMargin, {0., 0.5}).angular, 0.5);
  robot.footprint = Footprint::Rectangle(0.5, 0.2, 0.2);
  EXPECT_EQ(LimitSpeed(beside, robot, kMargin, {0., 0.5}).angular, 0.);
  EXPECT_EQ(LimitSpeed(beside, robot, kMargin, {0., -0.5}).angular, -0.5);
}

TEST(SpeedLimiterTest, StopsOnNonsense) {
  const double nan = std::nan("");
  const RobotLimits robot;
  EXPECT_EQ(LimitSpeed({}, robot, kMargin, {nan, 0.1}).linear, 0.);
  EXPECT_EQ(LimitSpeed({}, robot, kMargin, {0.1, nan}).linear, 0.);
  EXPECT_EQ(LimitSpeed({{nan, 0.}, {0.3, INFINITY}}, robot, kMargin, {0.5, 0.})
                .linear,
            0.5);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
