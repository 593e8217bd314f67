// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/truth.h"

#include <cmath>
#include <map>
#include <string>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

std::unique_ptr<const Simulation> Create(const std::string& text) {
  auto world = ParseWorld(text, "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  auto simulation = Simulation::Create(*std::move(world), SimulationOptions());
  EXPECT_TRUE(simulation.ok()) << simulation.status();
  return *std::move(simulation);
}

// A hall of 20 m by 12 m with a wall across, driven round twice; on the second
// round the far side of the wall is 1.2 m away but out of sight.
constexpr char kRounds[] = R"(
rectangle 0 0 20 12
rectangle 4 5.9 16 6.1
laser     beams=360 fov=360
robot     speed=0.6 radius=0.2
start     2 3 0
goto      18 3
goto      18 9
goto      2 9
goto      2 3
goto      18 3
goto      18 9
goto      2 9
goto      2 3
revisit   p 10 3
key_distance k 0 3 20 3
)";

TEST(TruthTest, TrajectoryHasEveryScan) {
  const auto simulation = Create(kRounds);
  const auto trajectory = TrueTrajectory(*simulation);
  ASSERT_EQ(trajectory.size(), simulation->num_scans());
  EXPECT_EQ(trajectory[0].time, 100000000000);
  EXPECT_EQ(trajectory[3].time, 100300000000);
  EXPECT_EQ(trajectory[30].pose.x, simulation->drive().PoseAt(3.).x);
}

TEST(TruthTest, RelationsComposeToThePoses) {
  const auto simulation = Create(kRounds);
  const auto trajectory = TrueTrajectory(*simulation);
  std::map<io::TimeNs, Pose2> poses;
  for (const TruePose& pose : trajectory) poses[pose.time] = pose.pose;
  const auto relations = SequentialRelations(trajectory);
  ASSERT_GT(relations.size(), 80);
  for (size_t i = 0; i != relations.size(); ++i) {
    const TrueRelation& relation = relations[i];
    ASSERT_LT(relation.first, relation.second);
    if (i > 0) {
      ASSERT_EQ(relation.first, relations[i - 1].second);
    }
    const Pose2 second = poses.at(relation.first) * relation.relative;
    ASSERT_NEAR(second.x, poses.at(relation.second).x, 1e-9);
    ASSERT_NEAR(second.y, poses.at(relation.second).y, 1e-9);
    ASSERT_LT(relation.relative.translation().norm(), 1.3);
  }
}

TEST(TruthTest, LoopsAreNearOldAndVisible) {
  const auto simulation = Create(kRounds);
  const auto trajectory = TrueTrajectory(*simulation);
  const auto loops = LoopRelations(*simulation, trajectory);
  // The second round, about one a metre.
  EXPECT_GT(loops.size(), 35);
  EXPECT_LT(loops.size(), 60);
  std::map<io::TimeNs, Pose2> poses;
  for (const TruePose& pose : trajectory) poses[pose.time] = pose.pose;
  for (const TrueRelation& loop : loops) {
    ASSERT_GT(io::ToSeconds(loop.second - loop.first), 60.);
    ASSERT_LE(loop.relative.translation().norm(), 1.5);
    ASSERT_TRUE(
        simulation->plan().Visible(poses.at(loop.first).translation(),
                                   poses.at(loop.second).translation()));
  }
}

TEST(TruthTest, WallsAndDirectionsSeparate) {
  // There and back on both sides of a thin wall, 1 m apart: no loops across it;
  // with a laser that looks forward only, none against the direction either.
  const std::string text =
      "polyline 2 0.5 60 0.5\nrobot radius=0.2 speed=1\nstart 1 0 0\n"
      "goto 62 0\ngoto 62 1\ngoto 1 1\n";
  const auto wide = Create(text + "laser beams=360 fov=360");
  for (const TrueRelation& loop : LoopRelations(*wide, TrueTrajectory(*wide))) {
    // Only at the open end near x = 1.
    const double time = io::ToSeconds(loop.second) - wide->world().begin;
    ASSERT_LT(wide->drive().PoseAt(time).x, 3.6);
  }
  const auto narrow = Create(
      "laser beams=180 fov=180\nrobot speed=1\nstart 1 0 0\ngoto 62 0\n"
      "goto 1 0");
  EXPECT_TRUE(LoopRelations(*narrow, TrueTrajectory(*narrow)).empty());
}

TEST(TruthTest, PlacesAreCountedPerPass) {
  const auto simulation = Create(kRounds);
  const auto visits = PlaceVisits(*simulation, TrueTrajectory(*simulation));
  ASSERT_EQ(visits.size(), 2);
  for (int i = 0; i != 2; ++i) {
    EXPECT_EQ(visits[i].place, "p");
    EXPECT_EQ(visits[i].visit, i + 1);
    EXPECT_LT(visits[i].distance, 0.1);
    EXPECT_NEAR(visits[i].pose.x, 10., 0.11);
  }
  EXPECT_GT(io::ToSeconds(visits[1].time - visits[0].time), 40.);
}

TEST(TruthTest, KeyDistancesAreTransportedBack) {
  const auto simulation = Create(kRounds);
  const auto trajectory = TrueTrajectory(*simulation);
  const auto views = KeyDistanceViews(*simulation, trajectory);
  ASSERT_EQ(views.size(), 1);
  const KeyDistanceView& view = views[0];
  EXPECT_TRUE(view.seen);
  EXPECT_EQ(view.length, 20.);
  std::map<io::TimeNs, Pose2> poses;
  for (const TruePose& pose : trajectory) poses[pose.time] = pose.pose;
  const Eigen::Vector2d a = poses.at(view.time_a) * view.a_in_robot;
  const Eigen::Vector2d b = poses.at(view.time_b) * view.b_in_robot;
  EXPECT_NEAR((b - a).norm(), 20., 1e-9);
  EXPECT_LT(view.a_in_robot.norm(), 2.2);
}

TEST(TruthTest, KeyDistanceNeedsTheFieldOfView) {
  // Driving away from wall a with a laser that looks forward only.
  const std::string text =
      "rectangle 0 0 9 2\nkey_distance k 0 1 9 1\nlaser beams=181 fov=180\n";
  const auto away = Create(text + "start 2 1 0\ngoto 7 1");
  EXPECT_FALSE(KeyDistanceViews(*away, TrueTrajectory(*away))[0].seen);
  const auto turned = Create(text + "start 2 1 180\nwait 1\ngoto 7 1");
  EXPECT_TRUE(KeyDistanceViews(*turned, TrueTrajectory(*turned))[0].seen);
}

TEST(TruthTest, UnseenKeyDistanceSaysSo) {
  const auto simulation = Create(
      "rectangle 0 0 4 4\nrectangle 10 0 14 4\nstart 1 1 0\ngoto 3 1\n"
      "key_distance k 0 1 14 1");
  const auto views = KeyDistanceViews(*simulation, TrueTrajectory(*simulation));
  ASSERT_EQ(views.size(), 1);
  EXPECT_FALSE(views[0].seen);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
