// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/local_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(LocalObstaclesTest, AgreesWithBruteForce) {
  Random random(2);
  const io::OccupancyMap map = RandomMap(60, 60, 0.01, 0.01, &random);
  const Costmap costmap = MakeCostmap(map);
  ObstacleLayer layer(&costmap, ObstacleLayerOptions());
  ScanInMap scan;
  scan.laser = Eigen::Vector2d(3., 3.);
  scan.echoes = {{3.5, 3.5}, {2., 2.5}};
  layer.Update(scan);
  const std::vector<Eigen::Vector2d> echoes = {{3.2, 2.7}, {std::nan(""), 3.}};
  const Eigen::Vector2d center(3., 3.);
  const double half_width = 1.5;
  const LocalObstacles local(costmap, &layer, echoes, center, half_width);
  const GridGeometry& geometry = costmap.geometry();
  const Cell middle = geometry.CellAt(center);
  const int reach = 15;
  for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      double expected = std::numeric_limits<double>::infinity();
      for (int v = middle.y - reach; v <= middle.y + reach; ++v) {
        for (int u = middle.x - reach; u <= middle.x + reach; ++u) {
          const Cell cell{u, v};
          if (costmap.state(cell) != CellState::kFree || layer.IsMarked(cell) ||
              cell == geometry.CellAt(echoes[0])) {
            expected =
                std::min(expected, map.resolution * std::hypot(x - u, y - v));
          }
        }
      }
      EXPECT_NEAR(local.Distance(geometry.Center({x, y})), expected, 1e-5);
    }
  }
  EXPECT_EQ(local.Distance({3., 4.7}), 0.);
  // Between the centres of cells there are no steps.
  for (double x = 2.3; x < 3.7; x += 0.013) {
    EXPECT_NEAR(local.Distance({x, 3.01}), local.Distance({x + 0.005, 3.01}),
                0.00501)
        << x;
  }
}

TEST(LocalObstaclesTest, ClearanceIsThatOfTheNearestPart) {
  const Costmap costmap = MakeCostmap(RoomMap(6., 6.));
  const LocalObstacles local(costmap, nullptr, {{4., 3.}}, {3., 3.}, 2.);
  EXPECT_NEAR(local.Clearance(Footprint::Disc(0.25), Pose2(3., 3., 0.)), 0.75,
              0.05);
  Footprint footprint;
  footprint.parts = {{{0., 0.}, 0.2}, {{0.5, 0.}, 0.2}};
  EXPECT_NEAR(local.Clearance(footprint, Pose2(3., 3., 0.)), 0.3, 0.05);
  EXPECT_NEAR(local.Clearance(footprint, Pose2(3., 3., kPi)), 0.8, 0.05);
}

TEST(LocalObstaclesTest, FindsTheWiderPlaceBesideSomebody) {
  // A corridor of 2.4 m; somebody stands at the left of the robot.
  const Costmap costmap = MakeCostmap(RoomMap(12., 2.6));
  const Footprint disc = Footprint::Disc(0.25);
  const double margin = 0.05;
  std::vector<Eigen::Vector2d> person;
  for (double angle = 0.; angle < 2. * kPi; angle += 0.2) {
    person.emplace_back(6. + 0.2 * std::cos(angle),
                        2.17 + 0.2 * std::sin(angle));
  }
  const Pose2 pose(6., 1.7, 0.);
  const LocalObstacles local(costmap, nullptr, person, pose.translation(), 2.5);
  const auto place = local.FindWiderPlace(disc, margin, pose);
  ASSERT_TRUE(place.has_value());
  EXPECT_GT(place->clearance, 0.5);
  EXPECT_LT(place->position.y(), 1.3);
  EXPECT_LE((place->position - pose.translation()).norm(), 1.001);
  EXPECT_NEAR(place->clearance,
              local.Clearance(
                  disc, Pose2(place->position.x(), place->position.y(), 0.)),
              1e-9);
  // The way there comes nearer to nothing that is too near.
  double before = local.Clearance(disc, pose);
  for (double share = 0.05; share <= 1.; share += 0.05) {
    const Eigen::Vector2d p =
        pose.translation() + share * (place->position - pose.translation());
    const double clearance = local.Clearance(disc, Pose2(p.x(), p.y(), 0.));
    EXPECT_GT(clearance, std::min(margin, before - 0.005)) << share;
    before = clearance;
  }
}

TEST(LocalObstaclesTest, FindsNoWiderPlaceInTheWidest) {
  const Costmap costmap = MakeCostmap(RoomMap(12., 2.6));
  const LocalObstacles local(costmap, nullptr, {}, {6., 1.3}, 2.5);
  EXPECT_FALSE(
      local.FindWiderPlace(Footprint::Disc(0.25), 0.05, Pose2(6., 1.3, 0.))
          .has_value());
  // Nor through what is in between: a niche with room behind a wall.
  io::OccupancyMap map = RoomMap(12., 6.);
  FillBox(5., 2., 5.3, 4., 1.f, &map);
  FillBox(6.1, 2., 6.4, 4., 1.f, &map);
  FillBox(5., 2., 6.4, 2.3, 1.f, &map);
  FillBox(5., 3.7, 6.4, 4., 1.f, &map);
  const Costmap niche = MakeCostmap(map);
  const Pose2 inside(5.72, 3., 0.);
  const LocalObstacles walled(niche, nullptr, {}, inside.translation(), 2.5);
  const auto place = walled.FindWiderPlace(Footprint::Disc(0.25), 0.05, inside);
  if (place.has_value()) {
    EXPECT_LT((place->position - inside.translation()).norm(), 0.5);
  }
}

TEST(FootprintTest, DistanceIsThatOfTheNearestPart) {
  Footprint footprint;
  footprint.parts = {{{0., 0.}, 0.2}, {{0.5, 0.}, 0.1}};
  // Turned left: the second part is at (1, 2.5).
  const Pose2 pose(1., 2., 0.5 * kPi);
  EXPECT_NEAR(footprint.Distance(pose, {1., 3.}), 0.4, 1e-12);
  EXPECT_NEAR(footprint.Distance(pose, {1., 1.5}), 0.3, 1e-12);
  EXPECT_NEAR(footprint.Distance(pose, {1.1, 2.}), -0.1, 1e-12);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
