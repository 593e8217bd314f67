// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/local_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
