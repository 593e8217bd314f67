// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/path_planner.h"

#include <cmath>

#include "cartographer_ext/common/thread_time.h"
#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// Two rooms of 5 m by 6 m joined by a door.
io::OccupancyMap TwoRooms(const bool open) {
  io::OccupancyMap map = RoomMap(10., 6.);
  FillBox(4.95, 0., 5.05, 6., 1.f, &map);
  if (open) FillBox(4.9, 2.4, 5.1, 3.6, 0.f, &map);
  return map;
}

TEST(PathPlannerTest, GoesThroughTheDoor) {
  const Costmap costmap = MakeCostmap(TwoRooms(true));
  const Plan plan = PathPlanner(&costmap).MakePlan({1., 1.}, {9., 1.}, nullptr);
  ASSERT_TRUE(plan.found());
  EXPECT_EQ(plan.points.front(), Eigen::Vector2d(1., 1.));
  EXPECT_EQ(plan.points.back(), Eigen::Vector2d(9., 1.));
  // Around the door posts at (5, 2.4): 2 * hypot(4, 1.7) with some clearance.
  EXPECT_GT(plan.length, 2. * std::hypot(4., 1.4));
  EXPECT_LT(plan.length, 2. * std::hypot(4., 2.) * 1.05);
  EXPECT_NEAR(PathLength(plan.points), plan.length, 1e-12);
  // Every point between the corners keeps the robot off the walls.
  for (size_t i = 1; i < plan.points.size(); ++i) {
    for (double ratio = 0.; ratio <= 1.; ratio += 0.01) {
      const Eigen::Vector2d p =
          plan.points[i - 1] + ratio * (plan.points[i] - plan.points[i - 1]);
      EXPECT_GT(costmap.ObstacleDistance(costmap.geometry().CellAt(p)),
                costmap.options().inscribed_radius);
    }
  }
}

TEST(PathPlannerTest, GivesTheReason) {
  io::OccupancyMap map = TwoRooms(false);
  FillBox(1., 4., 1.5, 4.5, io::OccupancyMap::Unknown(), &map);
  const Costmap costmap = MakeCostmap(map);
  PathPlanner planner(&costmap);
  const Eigen::Vector2d start(2., 2.);
  const double nan = std::nan("");
  const auto outcome = [&](const double x, const double y) {
    return planner.MakePlan(start, {x, y}, nullptr).outcome;
  };
  EXPECT_EQ(outcome(3., 3.), PlanOutcome::kFound);
  EXPECT_EQ(outcome(8., 2.), PlanOutcome::kUnreachable);
  EXPECT_EQ(outcome(5., 2.), PlanOutcome::kGoalOccupied);
  EXPECT_EQ(outcome(1.2, 4.2), PlanOutcome::kGoalUnknown);
  EXPECT_EQ(outcome(4.8, 2.), PlanOutcome::kGoalTooNear);
  EXPECT_EQ(outcome(20., 2.), PlanOutcome::kGoalOutside);
  EXPECT_EQ(outcome(1e300, 2.), PlanOutcome::kGoalOutside);
  EXPECT_EQ(outcome(nan, 2.), PlanOutcome::kNotFinite);
  EXPECT_EQ(planner.MakePlan({nan, 0.}, {3., 3.}, nullptr).outcome,
            PlanOutcome::kNotFinite);
  EXPECT_EQ(planner.MakePlan({40., 0.}, {3., 3.}, nullptr).outcome,
            PlanOutcome::kStartBlocked);
}

TEST(PathPlannerTest, TellsObstaclesFromWalls) {
  const Costmap costmap = MakeCostmap(TwoRooms(true));
  PathPlanner planner(&costmap);
  ObstacleLayer layer(&costmap, ObstacleLayerOptions());
  ScanInMap scan;
  scan.laser = Eigen::Vector2d(3., 3.);
  for (double y = 2.4; y < 3.6; y += 0.05) scan.echoes.emplace_back(5., y);
  layer.Update(scan);
  // What has just appeared may be somebody who passes by.
  EXPECT_TRUE(planner.MakePlan({1., 1.}, {9., 1.}, &layer).found());
  scan.time = 1.;
  layer.Update(scan);
  EXPECT_EQ(planner.MakePlan({1., 1.}, {9., 1.}, &layer).outcome,
            PlanOutcome::kObstructed);
  EXPECT_EQ(planner.MakePlan({1., 1.}, {4.6, 3.}, &layer).outcome,
            PlanOutcome::kFound);
  EXPECT_EQ(planner.MakePlan({1., 1.}, {5., 3.}, &layer).outcome,
            PlanOutcome::kGoalObstructed);
}

TEST(PathPlannerTest, LeavesABlockedStart) {
  const Costmap costmap = MakeCostmap(TwoRooms(true));
  const Plan plan =
      PathPlanner(&costmap).MakePlan({0.2, 3.}, {3., 3.}, nullptr);
  ASSERT_TRUE(plan.found());
  EXPECT_EQ(plan.points.front(), Eigen::Vector2d(0.2, 3.));
}

TEST(PathPlannerTest, SimplifiedPathCostsNoMore) {
  Random random(5);
  for (int trial = 0; trial != 30; ++trial) {
    const io::OccupancyMap map = RandomMap(60, 60, 0.01, 0., &random);
    const Costmap costmap = MakeCostmap(map);
    const WeightGrid& weights = costmap.weights();
    const GridPath path = GridSearch().Search(weights, {5, 5}, {55, 50});
    if (!path.found) continue;
    const std::vector<Cell> corners = SimplifyPath(weights, path.cells, 0.02);
    ASSERT_EQ(corners.front(), path.cells.front());
    ASSERT_EQ(corners.back(), path.cells.back());
    EXPECT_LE(corners.size(), path.cells.size());
    double before = 0., after = 0.;
    for (size_t i = 1; i < path.cells.size(); ++i) {
      before += LineCost(weights, path.cells[i - 1], path.cells[i]);
    }
    for (size_t i = 1; i < corners.size(); ++i) {
      after += LineCost(weights, corners[i - 1], corners[i]);
    }
    EXPECT_TRUE(std::isfinite(after));
    EXPECT_LE(after, 1.03 * before);
  }
}

TEST(PathPlannerTest, LineCostIsWeightTimesLength) {
  WeightGrid grid;
  grid.width = 5;
  grid.height = 1;
  grid.weights = {4, 8, 8, 4, kBlocked};
  EXPECT_NEAR(LineCost(grid, {0, 0}, {3, 0}), 0.5 * 4 + 8 + 8 + 0.5 * 4, 1e-9);
  EXPECT_NEAR(LineCost(grid, {3, 0}, {0, 0}), 20., 1e-9);
  EXPECT_TRUE(std::isinf(LineCost(grid, {0, 0}, {4, 0})));
}

TEST(PathPlannerTest, CostsOfLinesDoNotDependOnDirection) {
  Random random(9);
  const io::OccupancyMap map = RandomMap(50, 50, 0.003, 0., &random);
  const Costmap costmap = MakeCostmap(map);
  for (int trial = 0; trial != 500; ++trial) {
    const Cell a{static_cast<int>(random.UniformInt(0, 49)),
                 static_cast<int>(random.UniformInt(0, 49))};
    const Cell b{static_cast<int>(random.UniformInt(0, 49)),
                 static_cast<int>(random.UniformInt(0, 49))};
    const double there = LineCost(costmap.weights(), a, b);
    const double back = LineCost(costmap.weights(), b, a);
    if (std::isfinite(there) && std::isfinite(back)) {
      EXPECT_NEAR(there, back, 1e-6 * (1. + there));
    }
  }
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
