// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/walkers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/arc.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kStep = 0.01;        // seconds
constexpr double kRobotRadius = 0.2;  // metres
constexpr double kTouching = kRobotRadius + 0.2;

// One person who walks at 0.8 m/s between (0, 0) and (8, 0), beside a wall.
class WalkersTest : public testing::Test {
 protected:
  WalkersTest()
      : motion_({Person()}, 1),
        plan_({{{4., 0.25}, {4., 5.}}, {{0., -3.}, {8., -3.}}}, {}) {}

  static simulation::MovingObstacle Person() {
    simulation::MovingObstacle person;
    person.radius = 0.2;
    person.speed = 0.8;
    person.path = {{0., 0.}, {8., 0.}};
    return person;
  }

  Walkers Make(const bool attentive) const {
    WalkerOptions options;
    options.attentive = attentive;
    return Walkers(&motion_, &plan_, kRobotRadius, options);
  }

  // Least distance between the outlines while the robot drives on its arc.
  double LeastGap(const Pose2& start, const Velocity& velocity,
                  const double seconds, Walkers* const walkers) const {
    double least = std::numeric_limits<double>::infinity();
    const int steps = std::lround(seconds / kStep);
    for (int i = 0; i != steps; ++i) {
      const double time = i * kStep;
      const Pose2 robot =
          start * ArcPose(velocity.linear * time, velocity.angular * time);
      walkers->Advance(kStep, robot, velocity);
      least = std::min(
          least,
          (walkers->At()[0].center - robot.translation()).norm() - kTouching);
    }
    return least;
  }

  double DistanceFromLoop(const double time, const Walkers& walkers) const {
    return (walkers.At()[0].center - motion_.At(time)[0].center).norm();
  }

  const simulation::ObstacleMotion motion_;
  const simulation::RayCaster plan_;
};

TEST_F(WalkersTest, TheInattentiveWalkThroughTheRobot) {
  Walkers walkers = Make(false);
  EXPECT_LT(LeastGap({3., 0., 0.}, {}, 12., &walkers), -0.3);
  EXPECT_LT(DistanceFromLoop(12., walkers), 1e-6);
  EXPECT_EQ(walkers.waited_seconds(), 0.);
}

TEST_F(WalkersTest, TheAttentiveKeepTheirLoopWhereNobodyIs) {
  Walkers walkers = Make(true);
  LeastGap({4., -2., 0.}, {}, 25., &walkers);
  EXPECT_LT(DistanceFromLoop(25., walkers), 1e-6);
  EXPECT_EQ(walkers.waited_seconds(), 0.);
}

TEST_F(WalkersTest, StopBeforeAStationaryRobotAndTurnRound) {
  Walkers walkers = Make(true);
  const Pose2 robot(3., 0., 0.);
  EXPECT_GT(LeastGap(robot, {}, 5., &walkers), 0.1);
  EXPECT_GT(walkers.waited_seconds(), 1.);
  EXPECT_LT(walkers.At()[0].center.x(), 3.);
  // Back to the start of the loop, and to the robot again.
  const double before = walkers.At()[0].center.x();
  LeastGap(robot, {}, 3., &walkers);
  EXPECT_LT(walkers.At()[0].center.x(), before - 0.3);
  EXPECT_GT(LeastGap(robot, {}, 60., &walkers), 0.1);
}

TEST_F(WalkersTest, WalkOnWhenTheRobotHasGone) {
  Walkers walkers = Make(true);
  // Crosses the path at x = 2 when the person comes there.
  EXPECT_GT(LeastGap({2., -1.3, 0.5 * kPi}, {0.5, 0.}, 9., &walkers), 0.);
  EXPECT_GT(walkers.waited_seconds(), 0.5);
  EXPECT_GT(walkers.At()[0].center.x(), 4.);
  Walkers inattentive = Make(false);
  EXPECT_LT(LeastGap({2., -1.3, 0.5 * kPi}, {0.5, 0.}, 9., &inattentive), 0.);
}

TEST_F(WalkersTest, StopForARobotThatDrawsInAheadOfThem) {
  // The robot is slower and drives diagonally into the lane of the person.
  Walkers walkers = Make(true);
  EXPECT_GT(LeastGap({1., -0.65, 0.35}, {0.44, -0.06}, 6., &walkers), 0.);
  Walkers inattentive = Make(false);
  EXPECT_LT(LeastGap({1., -0.65, 0.35}, {0.44, -0.06}, 6., &inattentive), 0.);
}

TEST_F(WalkersTest, DoNotNoticeWhoComesFromBehind) {
  Walkers walkers = Make(true);
  EXPECT_LT(LeastGap({-1.5, 0., 0.}, {1.2, 0.}, 6., &walkers), 0.);
  EXPECT_LT(DistanceFromLoop(6., walkers), 0.5);
}

TEST_F(WalkersTest, DoNotSeeThroughWalls) {
  // The robot comes from behind the wall at x = 4 at the last moment.
  const Pose2 robot(5.5, 1.2, -0.5 * kPi - 0.6);
  Walkers walkers = Make(true);
  for (int i = 0; i != 450; ++i) walkers.Advance(kStep, robot, {0.5, 0.});
  EXPECT_EQ(walkers.waited_seconds(), 0.);
  // Without the wall it would have been seen to come.
  const simulation::RayCaster open({{{0., -3.}, {8., -3.}}}, {});
  Walkers seeing(&motion_, &open, kRobotRadius, {});
  for (int i = 0; i != 450; ++i) seeing.Advance(kStep, robot, {0.5, 0.});
  EXPECT_GT(seeing.waited_seconds(), 0.);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
