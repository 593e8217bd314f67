// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/moving_obstacles.h"

#include <cmath>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// The side of a disc that a laser at the origin sees, with noise.
void AddDisc(const Eigen::Vector2d& center, const double radius,
             Random* const random,
             std::vector<MovingObstacles::Echo>* const echoes) {
  const double bearing = std::atan2(-center.y(), -center.x());
  for (double angle = -1.2; angle <= 1.2; angle += 0.15) {
    const double r = radius + 0.015 * random->Normal();
    echoes->push_back({center + r * Eigen::Vector2d(std::cos(bearing + angle),
                                                    std::sin(bearing + angle)),
                       0.});
  }
}

TEST(MovingObstaclesTest, MeasuresTheVelocityOfAPerson) {
  Random random(4);
  MovingObstacles obstacles((MovingObstacleOptions()));
  const Eigen::Vector2d velocity(0.2, 1.);
  for (int i = 0; i != 10; ++i) {
    const double time = 0.1 * i;
    std::vector<MovingObstacles::Echo> echoes;
    AddDisc(Eigen::Vector2d(3., -1.) + time * velocity, 0.2, &random, &echoes);
    AddDisc({4., 2.}, 0.3, &random, &echoes);  // stationary
    obstacles.Update(echoes, time);
  }
  const std::vector<MovingDisc> moving = obstacles.Moving(0.9);
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_NEAR(moving[0].velocity.x(), 0.2, 0.2);
  EXPECT_NEAR(moving[0].velocity.y(), 1., 0.2);
  EXPECT_LT((moving[0].position - Eigen::Vector2d(3.18, -0.1)).norm(), 0.25);
  // Out of sight it goes on, for a while.
  obstacles.Update({}, 1.5);
  ASSERT_EQ(obstacles.Moving(1.5).size(), 1u);
  EXPECT_NEAR(obstacles.Moving(1.5)[0].position.y(), 0.5, 0.35);
  obstacles.Update({}, 3.5);
  EXPECT_TRUE(obstacles.Moving(3.5).empty());
}

// Updates for a person at each of the places, 0.1 s apart.
void Walk(const std::vector<Eigen::Vector2d>& places,
          MovingObstacles* const obstacles) {
  Random random(4);
  for (size_t i = 0; i != places.size(); ++i) {
    std::vector<MovingObstacles::Echo> echoes;
    AddDisc(places[i], 0.2, &random, &echoes);
    obstacles->Update(echoes, 0.1 * i);
  }
}

TEST(MovingObstaclesTest, RemembersForLongerWhereItDoesNotLook) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i != 10; ++i) places.emplace_back(-1., -2. + 0.1 * i);
  for (const bool in_view : {false, true}) {
    MovingObstacles obstacles((MovingObstacleOptions()));
    Walk(places, &obstacles);
    const auto sees = [in_view](const Eigen::Vector2d&) { return in_view; };
    for (int i = 10; i != 50; ++i) obstacles.Update({}, 0.1 * i, sees);
    EXPECT_EQ(obstacles.Moving(4.9).size(), in_view ? 0u : 1u);
    for (int i = 50; i != 70; ++i) obstacles.Update({}, 0.1 * i, sees);
    EXPECT_TRUE(obstacles.Moving(6.9).empty());
  }
}

TEST(MovingObstaclesTest, SomebodyWhoTurnsRoundGoesOnBeingSomebody) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i != 12; ++i) places.emplace_back(2., 0.08 * i);
  MovingObstacles obstacles((MovingObstacleOptions()));
  Walk(places, &obstacles);
  Random random(5);
  for (int i = 12; i != 24; ++i) {
    std::vector<MovingObstacles::Echo> echoes;
    AddDisc({2., 0.08 * (23 - i)}, 0.2, &random, &echoes);
    obstacles.Update(echoes, 0.1 * i);
    EXPECT_EQ(obstacles.Moving(0.1 * i).size(), 1u) << i;
  }
}

TEST(MovingObstaclesTest, WhatOnlySeemsToMoveStays) {
  // Seen from here and from there: fast, but to and fro within a decimetre.
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i != 30; ++i) places.emplace_back(2., i % 2 == 0 ? 0. : 0.1);
  MovingObstacles obstacles((MovingObstacleOptions()));
  Walk(places, &obstacles);
  EXPECT_TRUE(obstacles.Moving(2.9).empty());
}

TEST(MovingObstaclesTest, LeavesOutWallsAndSingleEchoes) {
  MovingObstacles obstacles((MovingObstacleOptions()));
  for (int i = 0; i != 10; ++i) {
    std::vector<MovingObstacles::Echo> echoes;
    for (double y = 0.; y < 3.; y += 0.1)
      echoes.push_back({{2. + 0.1 * i, y}, 0.});
    echoes.push_back({{5., 5. + 0.1 * i}, 0.});
    echoes.push_back({{std::nan(""), 0.}, 0.});
    obstacles.Update(echoes, 0.1 * i);
  }
  EXPECT_TRUE(obstacles.Moving(0.9).empty());
}

TEST(MovingObstaclesTest, JoinsTheFirstAndTheLastBeam) {
  // A person behind the robot, where the scan begins and ends.
  MovingObstacles obstacles((MovingObstacleOptions()));
  for (int i = 0; i != 8; ++i) {
    const double y = -0.4 + 0.1 * i;
    obstacles.Update({{{-2., y + 0.01}, 0.},
                      {{-1.95, y + 0.1}, 0.},
                      {{5., 5.}, 0.},
                      {{5., 5.1}, 0.},
                      {{-1.95, y - 0.1}, 0.},
                      {{-2., y - 0.01}, 0.}},
                     0.1 * i);
  }
  const auto moving = obstacles.Moving(0.7);
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_NEAR(moving[0].velocity.y(), 1., 0.15);
}

TEST(MovingObstaclesTest, WhatWasThereBeforeDoesNotMove) {
  // The middle of what is seen wanders over a long thing as the robot passes.
  MovingObstacles obstacles((MovingObstacleOptions()));
  for (const double age : {0., 1.5}) {
    for (int i = 0; i != 8; ++i) {
      std::vector<MovingObstacles::Echo> echoes;
      for (int j = 0; j != 5; ++j) {
        echoes.push_back({{2., 0.08 * i + 0.1 * j}, age});
      }
      obstacles.Update(echoes, 10. * age + 0.1 * i);
    }
    EXPECT_EQ(obstacles.Moving(10. * age + 0.7).size(), age == 0. ? 1u : 0u);
  }
}

TEST(MovingObstaclesTest, IsBounded) {
  MovingObstacleOptions options;
  options.max_tracks = 3;
  MovingObstacles obstacles(options);
  for (int i = 0; i != 5; ++i) {
    std::vector<MovingObstacles::Echo> echoes;
    for (int j = 0; j != 20; ++j) {
      echoes.push_back({{2. * j, 0.08 * i}, 0.});
      echoes.push_back({{2. * j + 0.1, 0.08 * i}, 0.});
    }
    obstacles.Update(echoes, 0.1 * i);
  }
  EXPECT_EQ(obstacles.Moving(0.4).size(), 3u);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
