// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/costmap.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(CostmapTest, AgreesWithBruteForce) {
  Random random(3);
  for (const bool unknown_is_free : {false, true}) {
    const io::OccupancyMap map = RandomMap(40, 30, 0.02, 0.01, &random);
    CostmapOptions options;
    options.unknown_is_free = unknown_is_free;
    const Costmap costmap = MakeCostmap(map, options);
    for (int y = 0; y != map.height; ++y) {
      for (int x = 0; x != map.width; ++x) {
        double wall = std::numeric_limits<double>::infinity();
        double obstacle = wall;
        for (int v = 0; v != map.height; ++v) {
          for (int u = 0; u != map.width; ++u) {
            const double distance = map.resolution * std::hypot(x - u, y - v);
            const bool unknown = std::isnan(map.at(u, v));
            if (!unknown && map.at(u, v) > 0.5f)
              wall = std::min(wall, distance);
            if (unknown ? !unknown_is_free : map.at(u, v) > 0.5f) {
              obstacle = std::min(obstacle, distance);
            }
          }
        }
        EXPECT_NEAR(costmap.WallDistance(Cell{x, y}), wall, 1e-5);
        EXPECT_NEAR(costmap.ObstacleDistance({x, y}), obstacle, 1e-5);
        const double r = options.inscribed_radius + options.padding;
        const double big_r = options.inflation_radius;
        const double roomy = r + options.tight;
        const double ratio = (big_r - obstacle) / (big_r - roomy);
        const double expected =
            obstacle <= r + 1e-6       ? 0.
            : obstacle <= roomy + 1e-6 ? kMaxWeight
            : obstacle >= big_r
                ? kMinWeight
                : kMinWeight * (1. + options.clearance_weight * ratio * ratio);
        EXPECT_NEAR(costmap.weights().at({x, y}), expected, 0.51);
      }
    }
  }
}

TEST(CostmapTest, RefusesBadMaps) {
  const CostmapOptions options;
  EXPECT_FALSE(Costmap::Create(io::OccupancyMap(), options).ok());
  const auto walls = Costmap::Create(DrawMap({"##", "??"}, 0.05), options);
  ASSERT_FALSE(walls.ok());
  EXPECT_EQ(walls.status().message(), "the map has no free space");
  io::OccupancyMap map = RoomMap(2., 2.);
  map.resolution = std::nan("");
  EXPECT_FALSE(Costmap::Create(map, options).ok());
  map = RoomMap(2., 2.);
  map.origin.x = std::nan("");
  EXPECT_FALSE(Costmap::Create(map, options).ok());
  map = RoomMap(2., 2.);
  map.occupancy.pop_back();
  EXPECT_FALSE(Costmap::Create(map, options).ok());
}

TEST(CostmapTest, RefusesBadOptions) {
  const io::OccupancyMap map = RoomMap(2., 2.);
  CostmapOptions options;
  options.inscribed_radius = 0.;
  EXPECT_FALSE(Costmap::Create(map, options).ok());
  options = CostmapOptions();
  options.inflation_radius = 0.1;
  EXPECT_FALSE(Costmap::Create(map, options).ok());
  options = CostmapOptions();
  options.clearance_weight = 15.5;
  EXPECT_FALSE(Costmap::Create(map, options).ok());
  options.clearance_weight = std::nan("");
  EXPECT_FALSE(Costmap::Create(map, options).ok());
}

TEST(CostmapTest, KnowsTheStateOfCells) {
  const Costmap costmap = MakeCostmap(DrawMap({"#.", "?."}, 0.5));
  EXPECT_EQ(costmap.state({0, 1}), CellState::kOccupied);
  EXPECT_EQ(costmap.state({0, 0}), CellState::kUnknown);
  EXPECT_EQ(costmap.state({1, 0}), CellState::kFree);
  EXPECT_EQ(costmap.state({2, 0}), CellState::kUnknown);
  EXPECT_EQ(costmap.ObstacleDistance({-1, 0}), 0.);
  EXPECT_TRUE(std::isinf(costmap.WallDistance(Cell{5, 5})));
}

TEST(CostmapTest, FollowsATurnedOrigin) {
  const Costmap costmap =
      MakeCostmap(DrawMap({"..#", "..."}, 1., Pose2(10., 5., kPi / 2.)));
  // Cell (2, 1) lies 1.5 to the left and 2.5 ahead of the origin.
  EXPECT_EQ(costmap.geometry().CellAt({8.5, 7.5}), (Cell{2, 1}));
  EXPECT_NEAR(costmap.WallDistance(Eigen::Vector2d(8.5, 7.5)), 0., 1e-6);
  EXPECT_NEAR(costmap.geometry().Center({2, 1}).x(), 8.5, 1e-9);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
