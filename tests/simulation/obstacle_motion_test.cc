// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/obstacle_motion.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Eigen::Vector2d;

MovingObstacle Square() {
  MovingObstacle obstacle;
  obstacle.speed = 0.5;
  obstacle.radius = 0.3;
  obstacle.path = {Vector2d(0., 0.), Vector2d(2., 0.), Vector2d(2., 2.),
                   Vector2d(0., 2.)};
  return obstacle;
}

void ExpectNear(const Vector2d& actual, const Vector2d& expected) {
  EXPECT_NEAR(actual.x(), expected.x(), 1e-12);
  EXPECT_NEAR(actual.y(), expected.y(), 1e-12);
}

TEST(ObstacleMotionTest, WalksTheSquare) {
  const ObstacleMotion motion({Square()}, 0);
  ASSERT_EQ(motion.size(), 1);
  ExpectNear(motion.Position(0, 0.), Vector2d(0., 0.));
  ExpectNear(motion.Position(0, 2.), Vector2d(1., 0.));
  ExpectNear(motion.Position(0, 4.), Vector2d(2., 0.));
  ExpectNear(motion.Position(0, 7.), Vector2d(2., 1.5));
  ExpectNear(motion.Position(0, 14.), Vector2d(0., 1.));  // closing side
  ExpectNear(motion.Position(0, 16.), Vector2d(0., 0.));
  ExpectNear(motion.Position(0, 18.), Vector2d(1., 0.));
  EXPECT_EQ(motion.At(2.)[0].radius, 0.3);
  ExpectNear(motion.At(2.)[0].center, Vector2d(1., 0.));
}

TEST(ObstacleMotionTest, PhaseIsAFractionOfTheLoop) {
  MovingObstacle obstacle = Square();
  obstacle.phase = 0.25;
  const ObstacleMotion motion({obstacle}, 0);
  ExpectNear(motion.Position(0, 0.), Vector2d(2., 0.));
  ExpectNear(motion.Position(0, 2.), Vector2d(2., 1.));
}

TEST(ObstacleMotionTest, TwoPointsGoThereAndBack) {
  MovingObstacle obstacle;
  obstacle.speed = 1.;
  obstacle.path = {Vector2d(1., 1.), Vector2d(4., 1.)};
  const ObstacleMotion motion({obstacle}, 0);
  ExpectNear(motion.Position(0, 2.), Vector2d(3., 1.));
  ExpectNear(motion.Position(0, 5.), Vector2d(2., 1.));
}

TEST(ObstacleMotionTest, RandomPhaseFollowsTheSeed) {
  MovingObstacle obstacle = Square();
  obstacle.random_phase = true;
  const ObstacleMotion a({obstacle}, 1), again({obstacle}, 1), b({obstacle}, 2);
  ExpectNear(a.Position(0, 3.), again.Position(0, 3.));
  EXPECT_GT((a.Position(0, 3.) - b.Position(0, 3.)).norm(), 1e-6);
  // A neighbour's fixed phase leaves the draws of the others alone.
  const ObstacleMotion pair({Square(), obstacle}, 1);
  MovingObstacle other = obstacle;
  const ObstacleMotion both({other, obstacle}, 1);
  ExpectNear(pair.Position(1, 3.), both.Position(1, 3.));
}

TEST(ObstacleMotionTest, StandingAndDegenerateLoops) {
  MovingObstacle standing = Square();
  standing.speed = 0.;
  MovingObstacle point;
  point.path = {Vector2d(3., 3.), Vector2d(3., 3.)};
  const ObstacleMotion motion({standing, point}, 0);
  ExpectNear(motion.Position(0, 100.), Vector2d(0., 0.));
  ExpectNear(motion.Position(1, 100.), Vector2d(3., 3.));
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
