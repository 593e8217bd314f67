// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"

#include <cmath>

#include "cartographer_ext/navigation/closed_loop/run_report.h"
#include "cartographer_ext/navigation/closed_loop/shadow_localization.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/navigation/closed_loop/room_run.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(NavigationRunTest, DrivesAroundAnObstacleToItsGoals) {
  const Room& room = Room::Get();
  NavigationRunOptions options = room.Options();
  options.obstacles = 1;
  options.crossings = 1;
  const auto run =
      RunNavigation(room.world, room.map, room.configuration, options);
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->reached(), 2);
  EXPECT_EQ(run->static_collisions, 0);
  EXPECT_EQ(run->moving_collisions, 0);
  EXPECT_GT(run->least_clearance, 0.);
  ASSERT_EQ(run->goal_errors.size(), 2u);
  for (const double error : run->goal_errors) EXPECT_LT(error, 0.1);
  EXPECT_LT(MedianError(run->localization), 0.03);
  EXPECT_EQ(run->jumps, 0);
  EXPECT_EQ(run->late_optimizations, 0);
  EXPECT_GT(run->path_ratio, 0.95);
  EXPECT_LT(run->path_ratio, 1.4);
  // The map begins where its robot stood.
  EXPECT_NEAR(run->map_from_world.x, -1., 0.05);
  EXPECT_NEAR(run->map_from_world.y, -1., 0.05);
}

TEST(NavigationRunTest, TheSeedDecidesEverything) {
  const Room& room = Room::Get();
  NavigationRunOptions options = room.Options();
  options.goals = {{3., 2.}};
  options.keep_readings = true;
  const auto once =
      RunNavigation(room.world, room.map, room.configuration, options);
  const auto again =
      RunNavigation(room.world, room.map, room.configuration, options);
  ASSERT_TRUE(once.ok() && again.ok());
  EXPECT_EQ(once->seconds, again->seconds);
  EXPECT_EQ(once->travelled, again->travelled);
  EXPECT_EQ(MedianError(once->localization), MedianError(again->localization));
  // The same localisation on the same readings reports the same poses.
  const auto shadow =
      LocalizeAgain(*once, room.configuration, room.pbstream_filename);
  ASSERT_TRUE(shadow.ok()) << shadow.status();
  ASSERT_GE(shadow->errors.size(), once->localization.size());
  for (size_t i = 0; i != once->localization.size(); ++i) {
    EXPECT_EQ(shadow->errors[i].offset, once->localization[i].offset);
  }
  options.seed = 2;
  const auto other =
      RunNavigation(room.world, room.map, room.configuration, options);
  ASSERT_TRUE(other.ok());
  EXPECT_NE(other->travelled, once->travelled);
}

TEST(NavigationRunTest, SaysWhyAGoalIsNotReached) {
  const Room& room = Room::Get();
  NavigationRunOptions options = room.Options();
  options.goals = {{3.3, -0.5}, {100., 0.}, {1., 0.}};
  const auto run =
      RunNavigation(room.world, room.map, room.configuration, options);
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->reached(), 1);
  EXPECT_FALSE(run->goals[0].reached);
  EXPECT_EQ(run->goals[1].reason, ToString(PlanOutcome::kGoalOutside));
}

TEST(NavigationRunTest, InAnotherBuildingItStopsAndSaysSo) {
  const Room& room = Room::Get();
  NavigationRunOptions options = room.Options();
  options.max_seconds = 30.;
  simulation::World other = room.world;
  // Larger, and turned about the start.
  const Eigen::Vector2d start = other.start.translation();
  const Eigen::Matrix2d change =
      2.3 * Eigen::Rotation2Dd(0.6).toRotationMatrix();
  for (auto& segment : other.segments) {
    segment.a = start + change * (segment.a - start);
    segment.b = start + change * (segment.b - start);
  }
  const auto run = RunNavigation(other, room.map, room.configuration, options);
  ASSERT_TRUE(run.ok()) << run.status();
  EXPECT_EQ(run->reached(), 0);
  EXPECT_LT(run->travelled, 0.1);
  EXPECT_GT(run->lost_cycles, 100);
  ASSERT_EQ(run->goals.size(), 2u);
  EXPECT_THAT(run->goals[0].reason, testing::HasSubstr("stopped, lost: "));
  EXPECT_EQ(run->goals[1].reason, "out of time");
  EXPECT_THAT(ToText(*run), testing::HasSubstr("because the robot was lost"));
}

TEST(NavigationRunTest, RefusesWhatMakesNoSense) {
  const Room& room = Room::Get();
  simulation::World world = room.world;
  world.robot.radius = 0.;
  EXPECT_FALSE(
      RunNavigation(world, room.map, room.configuration, room.Options()).ok());
  io::OccupancyMap map = room.map;
  for (float& value : map.occupancy) value = 1.f;
  const auto no_space =
      RunNavigation(room.world, map, room.configuration, room.Options());
  ASSERT_FALSE(no_space.ok());
  EXPECT_EQ(no_space.status().message(), "the map has no free space");
  NavigationRunOptions options = room.Options();
  options.pbstream_filename = "/no/such.pbstream";
  EXPECT_FALSE(
      RunNavigation(room.world, room.map, room.configuration, options).ok());
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
