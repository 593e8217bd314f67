// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/dynamic_window.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/navigation/speed_limiter.h"
#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// Metres between two looks at an arc, and a little more.
constexpr double kStride = 0.06;

class DynamicWindowTest : public testing::Test {
 protected:
  DynamicWindowTest() : window_(robot_, options_) {}

  DynamicWindowInput Input(const LocalObstacles* const obstacles,
                           const Pose2& pose) const {
    DynamicWindowInput input;
    input.pose = pose;
    input.max_speed = robot_.max_speed;
    input.target = pose * Eigen::Vector2d(1., 0.);
    for (int i = 0; i != 20; ++i) {
      input.path.push_back(pose * Eigen::Vector2d(0.1 * i, 0.));
    }
    input.obstacles = obstacles;
    return input;
  }

  const RobotLimits robot_;
  const DynamicWindowOptions options_;
  const DynamicWindow window_;
};

TEST_F(DynamicWindowTest, WindowIsWhatOnePeriodReaches) {
  const VelocityWindow window = window_.WindowAround({0.4, 0.1}, 1.);
  EXPECT_NEAR(window.max_linear, 0.4 + 0.5 * 0.1, 1e-12);
  EXPECT_NEAR(window.min_linear, 0.4 - 1. * 0.1, 1e-12);
  EXPECT_NEAR(window.max_angular, 0.1 + 1.5 * 0.1, 1e-12);
  EXPECT_NEAR(window.min_angular, 0.1 - 1.5 * 0.1, 1e-12);
  const VelocityWindow fast = window_.WindowAround({0.7, 0.8}, 1.);
  EXPECT_EQ(fast.max_linear, robot_.max_speed);
  EXPECT_EQ(fast.max_angular, robot_.max_turn_rate);
  // Above the speed of this period: brakes as it can.
  const VelocityWindow slow = window_.WindowAround({0.7, 0.}, 0.2);
  EXPECT_LE(slow.min_linear, slow.max_linear);
  EXPECT_LE(slow.max_linear, 0.6 + 1e-12);
  EXPECT_EQ(window_.WindowAround({-0.2, 0.}, 1.).max_linear, 0.);
}

TEST_F(DynamicWindowTest, AdmissibleSetIsThatOfTheDefinition) {
  // Against a fine simulation: an arc is admissible if the robot, after the
  // reaction time, can brake to a stop with the margin kept.
  Random random(6);
  int admissible = 0, inadmissible = 0, unclear = 0;
  for (int trial = 0; trial != 160; ++trial) {
    const io::OccupancyMap map = RandomMap(80, 80, 0.006, 0., &random);
    const Costmap costmap = MakeCostmap(map);
    const Pose2 pose(4., 4., random.Uniform(-kPi, kPi));
    const LocalObstacles local(costmap, nullptr, {}, pose.translation(), 3.);
    if (local.Clearance(robot_.footprint, pose) < 0.15) continue;
    const DynamicWindowInput input = Input(&local, pose);
    for (double v = 0.1; v <= 0.7; v += 0.1) {
      for (double w = -0.8; w <= 0.81; w += 0.1) {
        const EvaluatedVelocity evaluated = window_.Evaluate(input, {v, w});
        // Contact shorter than a stride may be overlooked: it is where a cell
        // is grazed.
        double free = 3., surely_met = 3., met_since = -1.;
        for (double length = 0.; length < 3.; length += 0.002) {
          const double clearance = local.Clearance(
              robot_.footprint, pose * ArcPose(length, length * w / v));
          if (clearance >= options_.margin) {
            met_since = -1.;
            continue;
          }
          free = std::min(free, length);
          if (met_since < 0.) met_since = length;
          if (length - met_since > kStride) {
            surely_met = met_since;
            break;
          }
        }
        const double braking =
            v * robot_.reaction_seconds + v * v / (2. * robot_.deceleration);
        const double angle_needed = w * w / (2. * robot_.turn_acceleration);
        const auto stops = [&](const double length) {
          return braking <= length && angle_needed <= length * std::abs(w) / v;
        };
        if (stops(free - kStride)) {
          EXPECT_TRUE(evaluated.admissible) << v << " " << w << " " << free;
          ++admissible;
        } else if (!stops(surely_met + 0.02)) {
          EXPECT_FALSE(evaluated.admissible) << v << " " << w << " " << free;
          ++inadmissible;
        } else {
          ++unclear;
        }
      }
    }
  }
  EXPECT_GT(admissible, 500);
  EXPECT_GT(inadmissible, 100);
  EXPECT_LT(unclear, (admissible + inadmissible) / 4);
}

TEST_F(DynamicWindowTest, ChoosesFastAndStraightWhereNothingIs) {
  const Costmap costmap = MakeCostmap(RoomMap(10., 10.));
  const Pose2 pose(5., 5., 0.3);
  const LocalObstacles local(costmap, nullptr, {}, {5., 5.}, 2.5);
  DynamicWindowInput input = Input(&local, pose);
  input.current = {0.4, 0.};
  const auto best = window_.Choose(input);
  ASSERT_TRUE(best.has_value());
  EXPECT_NEAR(best->velocity.linear, 0.45, 1e-9);
  EXPECT_NEAR(best->velocity.angular, 0., 0.03);
  // Towards a target on the left.
  input.target = pose * Eigen::Vector2d(0.8, 0.6);
  input.path.clear();
  for (int i = 0; i != 10; ++i) {
    input.path.push_back(pose * Eigen::Vector2d(0.08 * i, 0.06 * i));
  }
  const auto left = window_.Choose(input);
  ASSERT_TRUE(left.has_value());
  EXPECT_GT(left->velocity.angular, 0.1);
}

TEST_F(DynamicWindowTest, NothingIsAdmissibleBeforeAWallTooNear) {
  const Costmap costmap = MakeCostmap(RoomMap(10., 10.));
  std::vector<Eigen::Vector2d> echoes;
  for (double y = 4.; y <= 6.; y += 0.02) echoes.emplace_back(5.5, y);
  const LocalObstacles local(costmap, nullptr, echoes, {5., 5.}, 2.5);
  DynamicWindowInput input = Input(&local, Pose2(5., 5., 0.));
  input.current = {0.7, 0.};
  EXPECT_FALSE(window_.Choose(input).has_value());
}

TEST_F(DynamicWindowTest, NobodyCanReachItBeforeItStands) {
  // Wherever somebody walks.
  const Costmap costmap = MakeCostmap(RoomMap(10., 10.));
  const LocalObstacles local(costmap, nullptr, {}, {5., 5.}, 2.5);
  DynamicWindowInput input = Input(&local, Pose2(5., 5., 0.));
  MovingDisc person;
  person.radius = 0.2;
  int admissible = 0;
  for (double bearing = -3.; bearing <= 3.; bearing += 0.25) {
    for (double distance = 0.5; distance <= 2.; distance += 0.1) {
      const Eigen::Vector2d away(std::cos(bearing), std::sin(bearing));
      person.position = Eigen::Vector2d(5., 5.) + distance * away;
      person.velocity = 0.6 * away;
      input.moving = {person};
      for (double v = 0.05; v <= 0.7; v += 0.05) {
        if (!window_.Evaluate(input, {v, 0.}).admissible) continue;
        ++admissible;
        const double reaction = robot_.reaction_seconds;
        const double end = reaction + v / robot_.deceleration;
        for (double time = 0.; time <= end; time += 0.05) {
          const double braked = std::max(0., time - reaction);
          const double x =
              5. + v * time - 0.5 * robot_.deceleration * braked * braked;
          EXPECT_GT((Eigen::Vector2d(x, 5.) - person.position).norm(),
                    0.25 + 0.2 + options_.walking_speed * time)
              << bearing << " " << distance << " " << v << " " << time;
        }
      }
    }
  }
  EXPECT_GT(admissible, 500);
}

TEST_F(DynamicWindowTest, BackingUpHeedsPeople) {
  const Costmap costmap = MakeCostmap(RoomMap(10., 10.));
  const LocalObstacles local(costmap, nullptr, {}, {5., 5.}, 2.5);
  DynamicWindowInput input = Input(&local, Pose2(5., 5., 0.));
  EXPECT_TRUE(window_.Evaluate(input, {-0.1, 0.}).admissible);
  MovingDisc person;
  person.radius = 0.2;
  person.position = Eigen::Vector2d(4.2, 5.);
  person.velocity = Eigen::Vector2d(0., 0.6);
  input.moving = {person};
  EXPECT_FALSE(window_.Evaluate(input, {-0.1, 0.}).admissible);
}

TEST_F(DynamicWindowTest, WhatIsTooNearMayBeLeftAndPassed) {
  const Costmap costmap = MakeCostmap(RoomMap(10., 10.));
  std::vector<Eigen::Vector2d> echoes;
  for (double x = 4.; x <= 6.; x += 0.02) echoes.emplace_back(x, 5.275);
  const LocalObstacles local(costmap, nullptr, echoes, {5., 5.}, 2.5);
  const Pose2 pose(5., 5., 0.);
  DynamicWindowInput input = Input(&local, pose);
  ASSERT_LT(local.Clearance(robot_.footprint, pose), options_.margin);
  EXPECT_TRUE(window_.Evaluate(input, {0., 0.6}).admissible);
  EXPECT_TRUE(window_.Evaluate(input, {0.2, 0.}).admissible);
  EXPECT_TRUE(window_.Evaluate(input, {0.2, -0.4}).admissible);
  EXPECT_FALSE(window_.Evaluate(input, {0.2, 0.4}).admissible);
}

TEST_F(DynamicWindowTest, GivesWayToWhatMoves) {
  const Costmap costmap = MakeCostmap(RoomMap(10., 10.));
  const LocalObstacles local(costmap, nullptr, {}, {5., 5.}, 2.5);
  DynamicWindowInput input = Input(&local, Pose2(5., 5., 0.));
  input.current = {0.6, 0.};
  MovingDisc person;
  person.radius = 0.2;
  // Arrives where the robot would be before it could stand.
  person.position = Eigen::Vector2d(5.5, 5.9);
  person.velocity = Eigen::Vector2d(0., -1.);
  input.moving = {person};
  EXPECT_FALSE(window_.Evaluate(input, {0.6, 0.}).admissible);
  // Standing is always permitted.
  EXPECT_TRUE(window_.Evaluate(input, {0., 0.}).admissible);
  // One that walks away is no reason to stop, unless so near that it could
  // turn round and reach the robot before that stands.
  input.moving[0].velocity = Eigen::Vector2d(0., 1.);
  EXPECT_FALSE(window_.Evaluate(input, {0.6, 0.}).admissible);
  EXPECT_TRUE(window_.Evaluate(input, {0.1, 0.}).admissible);
  input.moving[0].position.y() = 6.5;
  EXPECT_TRUE(window_.Evaluate(input, {0.6, 0.}).admissible);
  // From behind, faster than the robot: it has to stand before.
  input.moving[0].position = Eigen::Vector2d(4.2, 5.);
  input.moving[0].velocity = Eigen::Vector2d(1.2, 0.);
  EXPECT_FALSE(window_.Evaluate(input, {0.6, 0.}).admissible);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
