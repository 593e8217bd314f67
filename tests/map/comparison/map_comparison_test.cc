// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/comparison/map_comparison.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kCell = 0.05;

// A room of 12 m by 8 m with a partition and, if wanted, a cupboard; drawn with
// `map_from_room`.
io::OccupancyMap Room(const Pose2& map_from_room, const bool cupboard) {
  io::OccupancyMap map =
      io::OccupancyMap::Make(800, 800, kCell, Pose2(-20., -20., 0.));
  const auto line = [&](const double x0, const double y0, const double x1,
                        const double y1) {
    const double length = std::hypot(x1 - x0, y1 - y0);
    for (double s = 0.; s <= length; s += 0.02) {
      const Eigen::Vector2d at =
          map_from_room * Eigen::Vector2d(x0 + (x1 - x0) * s / length,
                                          y0 + (y1 - y0) * s / length);
      map.at(static_cast<int>((at.x() + 20.) / kCell),
             static_cast<int>((at.y() + 20.) / kCell)) = 1.f;
    }
  };
  line(0., 0., 12., 0.);
  line(12., 0., 12., 8.);
  line(12., 8., 0., 8.);
  line(0., 8., 0., 0.);
  line(4., 0., 4., 5.);
  line(4., 5., 6., 5.);
  if (cupboard) line(8., 3., 9.5, 3.);
  return map;
}

MapGraph Path(const Pose2& map_from_room) {
  MapGraph graph;
  for (int i = 0; i < 60; ++i) {
    GraphNode& node = graph.nodes[{0, i}];
    node.time = i * 1000000000LL;
    node.global_pose =
        map_from_room * Pose2(1. + 0.15 * i, 6. + std::sin(0.2 * i), 0.1 * i);
  }
  return graph;
}

TEST(MapComparisonTest, FindsAnyRotationByWallsAlone) {
  // Walls through the middle of cells: those on a border would all be drawn on
  // one side of it.
  const Pose2 middle(0.5 * kCell, 0.5 * kCell, 0.);
  const io::OccupancyMap first = Room(middle, false);
  for (const double theta : {0., 0.7, 2.5, -1.9}) {
    const Pose2 pose(1.2, -2.3, theta);
    const io::OccupancyMap second = Room(pose, false);
    const auto comparison =
        CompareMaps({nullptr, &first}, {nullptr, &second}, {});
    ASSERT_TRUE(comparison.ok()) << comparison.status();
    EXPECT_EQ(comparison->method, "walls");
    EXPECT_FALSE(comparison->trajectory.has_value());
    const Pose2 error = middle.Inverse() * comparison->first_from_second * pose;
    EXPECT_LT(error.translation().norm(), 0.05) << theta;
    EXPECT_LT(std::abs(error.theta), 0.01) << theta;
    EXPECT_TRUE(comparison->only_first.empty());
    EXPECT_TRUE(comparison->only_second.empty());
    const auto json = ToJson(*comparison);
    EXPECT_TRUE(json["trajectory_difference"]["mean"].is_null());
  }
}

TEST(MapComparisonTest, ListsTheWallThatOnlyOneMapHas) {
  const io::OccupancyMap first = Room(Pose2(), false);
  const io::OccupancyMap second = Room(Pose2(0.4, 0.2, 0.3), true);
  const auto comparison =
      CompareMaps({nullptr, &first}, {nullptr, &second}, {});
  ASSERT_TRUE(comparison.ok());
  EXPECT_TRUE(comparison->only_first.empty());
  ASSERT_EQ(comparison->lone_walls.size(), 1u);
  EXPECT_FALSE(comparison->lone_walls[0].in_first);
  EXPECT_NEAR(comparison->lone_walls[0].center.x(), 8.75, 0.1);
  EXPECT_NEAR(comparison->lone_walls[0].center.y(), 3., 0.1);
  EXPECT_NEAR(comparison->lone_walls[0].extent, 1.5, 0.15);
}

TEST(MapComparisonTest, KeepsUnmovedNodesInPlace) {
  const io::OccupancyMap map = Room(Pose2(), false);
  const MapGraph first = Path(Pose2());
  // The last third of the second map was carried away, and all of it lies in
  // another frame.
  const Pose2 frame(3., 1., 0.5);
  MapGraph second = Path(frame);
  for (int i = 40; i < 60; ++i) {
    GraphNode& node = second.nodes[{0, i}];
    node.global_pose =
        frame * Pose2(0., -2., 0.) * frame.Inverse() * node.global_pose;
  }
  const auto comparison = CompareMaps({&first, &map}, {&second, &map}, {});
  ASSERT_TRUE(comparison.ok());
  EXPECT_EQ(comparison->method, "nodes");
  const Pose2 error = comparison->first_from_second * frame;
  EXPECT_LT(error.translation().norm(), 1e-6);
  EXPECT_NEAR(comparison->agreement, 40. / 60., 1e-9);
  ASSERT_EQ(comparison->moved.size(), 1u);
  EXPECT_EQ(comparison->moved[0].first_node, (GraphId{0, 40}));
  EXPECT_EQ(comparison->moved[0].last_node, (GraphId{0, 59}));
  EXPECT_NEAR(comparison->moved[0].mean, 2., 1e-6);
  EXPECT_NEAR(comparison->trajectory->mean, 2. / 3., 1e-6);
  EXPECT_NEAR(comparison->trajectory->max, 2., 1e-6);
}

TEST(MapComparisonTest, RefusesWhatHasNoWalls) {
  const io::OccupancyMap map = Room(Pose2(), false);
  const io::OccupancyMap empty = io::OccupancyMap::Make(10, 10, kCell, Pose2());
  const auto comparison = CompareMaps({nullptr, &map}, {nullptr, &empty}, {});
  ASSERT_FALSE(comparison.ok());
  EXPECT_EQ(comparison.status().message(), "the second map has no walls");
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
