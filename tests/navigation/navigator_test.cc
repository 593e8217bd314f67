// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/navigator.h"

#include <cmath>
#include <limits>
#include <memory>

#include "absl/memory/memory.h"
#include "cartographer_ext/common/arc.h"
#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// A robot that does exactly what it is told, in a world that may have more in
// it than the map.
class Loop {
 public:
  Loop(const io::OccupancyMap& map, const io::OccupancyMap& world,
       const Pose2& start, const std::vector<Eigen::Vector2d>& goals,
       const double memory_seconds = ObstacleLayerOptions().memory_seconds)
      : world_(world), costmap_(MakeCostmap(map)), pose_(start) {
    options_.obstacles.memory_seconds = memory_seconds;
    navigator_ = absl::make_unique<Navigator>(&costmap_, options_, goals);
  }

  NavigatorScan MakeScan() const {
    NavigatorScan scan;
    scan.time = time_;
    scan.map_from_robot = pose_;
    scan.odometry_step = step_;
    scan.echoes = ScanOf(world_, pose_, 120);
    return scan;
  }

  Velocity Step() {
    navigator_->AddScan(MakeScan());
    return StepWithoutScan();
  }

  Velocity StepWithoutScan() {
    NavigatorStep step;
    step.time = time_;
    step.map_from_robot = pose_;
    step.velocity = velocity_;
    velocity_ = navigator_->Step(step);
    step_ = ArcPose(0.1 * velocity_.linear, 0.1 * velocity_.angular);
    pose_ = pose_ * step_;
    time_ += 0.1;
    return velocity_;
  }

  // Metres from the outline to the nearest occupied cell of the world.
  double Gap() const {
    const Costmap truth = MakeCostmap(world_);
    return truth.WallDistance(pose_.translation()) -
           options_.robot.footprint.inscribed_radius();
  }

  io::OccupancyMap world_;
  NavigatorOptions options_;
  Costmap costmap_;
  Pose2 pose_;
  Pose2 step_;
  Velocity velocity_;
  double time_ = 0.;
  std::unique_ptr<Navigator> navigator_;
};

// Two rooms with a door between them that is open in the map only.
struct ClosedDoor {
  ClosedDoor() : map(RoomMap(8., 6.)) {
    FillBox(5., 0., 5.1, 6., 1.f, &map);
    FillBox(5., 2.4, 5.1, 3.6, 0.f, &map);
    world = map;
    FillBox(5., 2.4, 5.1, 3.6, 1.f, &world);
  }
  io::OccupancyMap map, world;
};

TEST(NavigatorTest, ReachesItsGoals) {
  const io::OccupancyMap map = RoomMap(8., 6.);
  Loop loop(map, map, Pose2(1., 1., 0.), {{6., 4.}, {1., 1.}});
  for (int i = 0; i != 600 && !loop.navigator_->finished(); ++i) loop.Step();
  ASSERT_EQ(loop.navigator_->results().size(), 2u);
  EXPECT_TRUE(loop.navigator_->results()[0].reached);
  EXPECT_TRUE(loop.navigator_->results()[1].reached);
  // Nearer than the tolerance: localisation adds its error to this.
  EXPECT_LT((loop.pose_.translation() - Eigen::Vector2d(1., 1.)).norm(), 0.025);
  EXPECT_EQ(loop.navigator_->state(), DriveState::kFinished);
  EXPECT_EQ(loop.Step().linear, 0.);
}

TEST(NavigatorTest, DrivesAroundWhatTheMapDoesNotHave) {
  const io::OccupancyMap map = RoomMap(8., 6.);
  io::OccupancyMap world = map;
  FillBox(3.7, 2.2, 4.3, 3.6, 1.f, &world);
  Loop loop(map, world, Pose2(1., 3., 0.), {{7., 3.}});
  double gap = std::numeric_limits<double>::infinity();
  for (int i = 0; i != 600 && !loop.navigator_->finished(); ++i) {
    loop.Step();
    gap = std::min(gap, loop.Gap());
  }
  ASSERT_EQ(loop.navigator_->results().size(), 1u);
  EXPECT_TRUE(loop.navigator_->results()[0].reached)
      << loop.navigator_->results()[0].reason;
  EXPECT_GT(gap, 0.);
}

TEST(NavigatorTest, GivesReasonsForBadGoals) {
  io::OccupancyMap map = RoomMap(8., 6.);
  FillBox(5., 0., 5.1, 6., 1.f, &map);
  Loop loop(map, map, Pose2(1., 3., 0.),
            {{std::nan(""), 1.}, {5.05, 3.}, {7., 3.}, {30., 3.}, {2., 3.}});
  for (int i = 0; i != 300 && !loop.navigator_->finished(); ++i) loop.Step();
  const auto& results = loop.navigator_->results();
  ASSERT_EQ(results.size(), 5u);
  EXPECT_EQ(results[0].reason, ToString(PlanOutcome::kNotFinite));
  EXPECT_EQ(results[1].reason, ToString(PlanOutcome::kGoalOccupied));
  EXPECT_EQ(results[2].reason, ToString(PlanOutcome::kUnreachable));
  EXPECT_EQ(results[3].reason, ToString(PlanOutcome::kGoalOutside));
  EXPECT_TRUE(results[4].reached);
}

TEST(NavigatorTest, WaitsAndGivesUpBehindAClosedDoor) {
  const ClosedDoor rooms;
  // Echoes at the closed door are far enough from the door posts of the map.
  Loop loop(rooms.map, rooms.world, Pose2(2., 3., 0.), {{7., 3.}});
  bool obstructed = false;
  for (int i = 0; i != 3000 && !loop.navigator_->finished(); ++i) {
    loop.Step();
    obstructed =
        obstructed || loop.navigator_->state() == DriveState::kObstructed;
  }
  EXPECT_TRUE(obstructed);
  ASSERT_TRUE(loop.navigator_->finished());
  EXPECT_FALSE(loop.navigator_->results()[0].reached);
  EXPECT_NE(loop.navigator_->results()[0].reason.find("no progress"),
            std::string::npos);
  EXPECT_GT(loop.navigator_->recoveries(), 2);
}

TEST(NavigatorTest, RemembersAClosedDoorOnALongWayRound) {
  // The near one of two doors is closed, and the way to the other one takes
  // longer than marks out of sight are remembered.
  io::OccupancyMap map = RoomMap(8., 14.);
  FillBox(4., 0., 4.1, 14., 1.f, &map);
  FillBox(4., 1., 4.1, 2.2, 0.f, &map);
  FillBox(4., 12., 4.1, 13.2, 0.f, &map);
  // No view of the near door on the way.
  FillBox(2.7, 3., 4.1, 3.1, 1.f, &map);
  io::OccupancyMap world = map;
  FillBox(4., 1., 4.1, 2.2, 1.f, &world);
  Loop loop(map, world, Pose2(1.5, 1.6, 0.), {{6.5, 1.6}}, 5.);
  for (int i = 0; i != 1200 && !loop.navigator_->finished(); ++i) loop.Step();
  ASSERT_TRUE(loop.navigator_->finished());
  EXPECT_TRUE(loop.navigator_->results()[0].reached)
      << loop.navigator_->results()[0].reason;
  EXPECT_LT(loop.time_, 80.);
}

TEST(NavigatorTest, BacksUpOnlyTheWayItCame) {
  // Before a closed door, from where it has not moved yet: what is behind it
  // has never been driven.
  const ClosedDoor rooms;
  const Pose2 start(4.65, 3., 0.);
  Loop loop(rooms.map, rooms.world, start, {{7., 3.}});
  double moved = 0.;
  for (int i = 0; i != 3000 && !loop.navigator_->finished(); ++i) {
    loop.Step();
    moved = std::max(moved,
                     (loop.pose_.translation() - start.translation()).norm());
  }
  EXPECT_GT(loop.navigator_->recoveries(), 2);
  EXPECT_LT(moved, 0.15);
}

TEST(NavigatorTest, GivesWayToSomebodyWhoWaits) {
  // Somebody of radius 0.2 m comes along the wall of a corridor, stops before
  // the robot, on its goal, and walks on as soon as there is room beside it.
  const io::OccupancyMap map = RoomMap(12., 2.6);
  Loop loop(map, map, Pose2(5.8, 0.6, 0.), {{6.6, 0.6}, {10., 1.3}});
  Eigen::Vector2d person(9., 0.45);
  double least_gap = std::numeric_limits<double>::infinity();
  for (int i = 0; i != 1200 && !loop.navigator_->finished(); ++i) {
    loop.world_ = map;
    FillBox(person.x() - 0.18, person.y() - 0.18, person.x() + 0.18,
            person.y() + 0.18, 1.f, &loop.world_);
    const Velocity command = loop.Step();
    const Eigen::Vector2d to_robot = loop.pose_.translation() - person;
    const double gap = to_robot.norm() - 0.2 - 0.25;
    if (command.linear != 0.) least_gap = std::min(least_gap, gap);
    const bool blocked = to_robot.x() < 0. && std::abs(to_robot.y()) < 0.6;
    if (person.x() > 2. && (!blocked || gap > 0.2)) person.x() -= 0.07;
  }
  ASSERT_TRUE(loop.navigator_->finished());
  for (const GoalResult& result : loop.navigator_->results()) {
    EXPECT_TRUE(result.reached) << result.reason;
  }
  EXPECT_LT(loop.time_, 60.);
  EXPECT_EQ(loop.navigator_->times_given_way(), 1);
  EXPECT_EQ(loop.navigator_->recoveries(), 0);
  EXPECT_GT(least_gap, 0.);
}

TEST(NavigatorTest, DoesNotGiveWayWhereNobodyIs) {
  const io::OccupancyMap map = RoomMap(12., 2.6);
  Loop loop(map, map, Pose2(6., 0.85, kPi), {{10., 1.3}, {2., 1.3}});
  for (int i = 0; i != 900 && !loop.navigator_->finished(); ++i) loop.Step();
  EXPECT_TRUE(loop.navigator_->finished());
  EXPECT_EQ(loop.navigator_->times_given_way(), 0);
}

class NavigatorStopTest : public testing::Test {
 protected:
  NavigatorStopTest()
      : map_(RoomMap(8., 6.)),
        loop_(map_, map_, Pose2(1., 3., 0.), {{7., 3.}}) {
    for (int i = 0; i != 30; ++i) loop_.Step();
    EXPECT_GT(loop_.velocity_.linear, 0.5);
  }

  void ExpectStop(const DriveState state, const std::string& words) {
    const Velocity command = loop_.StepWithoutScan();
    EXPECT_EQ(command.linear, 0.);
    EXPECT_EQ(command.angular, 0.);
    EXPECT_EQ(loop_.navigator_->state(), state);
    EXPECT_NE(loop_.navigator_->message().find(words), std::string::npos)
        << loop_.navigator_->message();
  }

  const io::OccupancyMap map_;
  Loop loop_;
};

TEST_F(NavigatorStopTest, WhenTheScanIsEmpty) {
  NavigatorScan scan = loop_.MakeScan();
  scan.echoes.clear();
  loop_.navigator_->AddScan(scan);
  ExpectStop(DriveState::kBlind, "sees nothing");
}

TEST_F(NavigatorStopTest, WhenTheScanIsNotNumbers) {
  NavigatorScan scan = loop_.MakeScan();
  for (auto& echo : scan.echoes) echo.x() = std::nan("");
  loop_.navigator_->AddScan(scan);
  ExpectStop(DriveState::kBlind, "sees nothing");
}

TEST_F(NavigatorStopTest, WhenScansStop) {
  for (int i = 0; i != 4; ++i) loop_.StepWithoutScan();
  loop_.time_ += 0.2;
  ExpectStop(DriveState::kBlind, "no recent scan");
}

TEST_F(NavigatorStopTest, WhenThePoseIsNotANumber) {
  loop_.navigator_->AddScan(loop_.MakeScan());
  loop_.pose_.theta = std::nan("");
  ExpectStop(DriveState::kLost, "not a number");
}

TEST_F(NavigatorStopTest, WhenThePoseJumps) {
  NavigatorScan scan = loop_.MakeScan();
  scan.map_from_robot.x += 1.;
  loop_.navigator_->AddScan(scan);
  ExpectStop(DriveState::kLost, "lost: the pose jumped");
}

TEST_F(NavigatorStopTest, WhenTheScanContradictsTheMap) {
  // Somebody carries the robot away; localisation believes in its old place.
  io::OccupancyMap elsewhere = RoomMap(20., 20.);
  for (int i = 0; i != 12; ++i) {
    NavigatorScan scan = loop_.MakeScan();
    scan.echoes = ScanOf(elsewhere, Pose2(10., 10., 0.5), 120);
    loop_.navigator_->AddScan(scan);
    loop_.time_ += 0.1;
  }
  ExpectStop(DriveState::kLost, "at walls");
  EXPECT_FALSE(loop_.navigator_->finished());
  // Back on its map it goes on.
  for (int i = 0; i != 40; ++i) loop_.Step();
  EXPECT_GT(loop_.velocity_.linear, 0.3);
}

TEST_F(NavigatorStopTest, BeforeAnEchoInItsWay) {
  // Whatever the map and the localisation say.
  NavigatorScan scan = loop_.MakeScan();
  for (double y = -0.3; y <= 0.3; y += 0.02) scan.echoes.emplace_back(0.35, y);
  loop_.navigator_->AddScan(scan);
  const Velocity command = loop_.StepWithoutScan();
  EXPECT_EQ(command.linear, 0.);
}

TEST(NavigatorTest, DoesNotMoveWhileItIsTouched) {
  // It would have to turn round; somebody leans on it.
  const io::OccupancyMap map = RoomMap(8., 6.);
  Loop loop(map, map, Pose2(4., 3., 0.), {{1., 3.}});
  const auto step = [&loop] {
    NavigatorScan scan = loop.MakeScan();
    for (double bearing = 1.2; bearing < 1.8; bearing += 0.05) {
      scan.echoes.emplace_back(0.255 * std::cos(bearing),
                               0.255 * std::sin(bearing));
    }
    loop.navigator_->AddScan(scan);
    return loop.StepWithoutScan();
  };
  for (int i = 0; i != 150; ++i) {
    const Velocity command = step();
    EXPECT_EQ(command.linear, 0.);
    EXPECT_EQ(command.angular, 0.);
  }
  EXPECT_NE(loop.navigator_->message().find("touches"), std::string::npos);
  // What never goes is not waited for: turning brings the outline no nearer.
  double turned = 0.;
  for (int i = 0; i != 250; ++i) turned += std::abs(step().angular);
  EXPECT_GT(turned, 0.);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
