// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/buildings/floor_plan.h"

#include <algorithm>

#include "cartographer_ext/common/random.h"
#include "cartographer_ext/simulation/buildings/furniture.h"
#include "cartographer_ext/simulation/buildings/route.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Eigen::Vector2d;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(FloorPlanTest, LineToBoxIsTheLeastDistance) {
  Random random(3);
  const Box box = MakeBox(-1., -0.5, 2., 1.);
  for (int i = 0; i != 500; ++i) {
    const Vector2d a(random.Uniform(-4., 4.), random.Uniform(-4., 4.));
    const Vector2d b(random.Uniform(-4., 4.), random.Uniform(-4., 4.));
    double least = 1e9;
    for (int k = 0; k <= 2000; ++k) {
      least = std::min(
          least, box.exteriorDistance(Vector2d(a + (k / 2000.) * (b - a))));
    }
    EXPECT_NEAR(LineToBox(a, b, box), least, 5e-3);
  }
  EXPECT_DOUBLE_EQ(LineToBox({3., -9.}, {3., 9.}, box), 1.);
}

TEST(FloorPlanTest, FurnitureLeavesLanesFree) {
  FloorPlan plan;
  AddLane(AddNode({0., 2.}, &plan), AddNode({4., 2.}, &plan), &plan);
  Random random(1);
  const Box room = MakeBox(0., 0., 4., 4.);
  for (int i = 0; i != 20; ++i) FurnishOffice(room, 1., &random, &plan);
  ASSERT_FALSE(plan.occupied.empty());
  for (const Box& box : plan.occupied) {
    EXPECT_TRUE(room.contains(box));
    EXPECT_GE(LineToBox({0., 2.}, {4., 2.}, box), 0.55);
    for (const Box& other : plan.occupied) {
      if (&other != &box) {
        EXPECT_GT(box.exteriorDistance(other), 0.);
      }
    }
  }
}

// A piece stays within its footprint, whichever way it is turned.
TEST(FloorPlanTest, PiecesKeepTheirFootprint) {
  Random random(2);
  for (const Piece& piece :
       {Desk(), Cupboard(1.2, 0.4), Table(6), Bed(), RoundThing(0.3),
        ParkedCar(), Rack(3, 1., 0.8, &random)}) {
    for (const Side side : {kBelow, kRight, kAbove, kLeft}) {
      FloorPlan plan;
      Placement placement;
      placement.back = side;
      placement.corner = {5., -3.};
      ASSERT_TRUE(Place(piece, placement, &plan));
      const Box box = plan.occupied.front();
      for (const Segment& segment : plan.segments) {
        EXPECT_LT(box.exteriorDistance(segment.a), 1e-9);
        EXPECT_LT(box.exteriorDistance(segment.b), 1e-9);
      }
      for (const Disc& disc : plan.discs) {
        EXPECT_TRUE(box.contains(disc.center));
      }
      EXPECT_FALSE(Place(piece, placement, &plan));
    }
  }
}

// Three nodes in a row and a square behind them.
FloorPlan SmallGrid() {
  FloorPlan plan;
  const auto grid = AddLaneGrid({0., 10., 20.}, {0., 5.}, &plan);
  plan.round = {grid[0][0], grid[2][0], grid[0][0]};
  plan.overlap = 0.;
  return plan;
}

TEST(RouteTest, TakesTheShortestWay) {
  FloorPlan plan = SmallGrid();
  // Nodes count up along y first: (0, 0) is 0, (10, 0) is 2, (20, 0) is 4.
  EXPECT_THAT(RouteNodes(plan, RouteOptions()), ElementsAre(0, 2, 4, 2, 0));
  RouteOptions car;
  car.turns_back = false;
  EXPECT_THAT(RouteNodes(plan, car), ElementsAre(0, 2, 4, 5, 3, 1, 0));
  plan.overlap = 12.;
  RouteOptions twice;
  twice.laps = 2;
  EXPECT_THAT(RouteNodes(plan, twice),
              ElementsAre(0, 2, 4, 2, 0, 2, 4, 2, 0, 2, 4));
}

TEST(RouteTest, SaysWhereNoWayLeads) {
  FloorPlan plan;
  AddLane(AddNode({0., 0.}, &plan), AddNode({5., 0.}, &plan), &plan);
  AddNode({9., 9.}, &plan);
  plan.round = {0, 2, 0};
  EXPECT_THAT(RouteNodes(plan, RouteOptions()), IsEmpty());
  plan.round = {0, 1, 0};
  RouteOptions car;
  car.turns_back = false;
  EXPECT_THAT(RouteNodes(plan, car), IsEmpty());
}

TEST(RouteTest, WaypointsStrayWithinTheSlack) {
  FloorPlan plan = SmallGrid();
  plan.lateral_slack = 0.3;
  Random random(4);
  const auto points = Waypoints(plan, {0, 2, 4, 5}, &random);
  EXPECT_EQ(points.front(), Vector2d(0., 0.));
  EXPECT_EQ(points.back(), Vector2d(20., 5.));
  ASSERT_GT(points.size(), 4u);
  double largest = 0.;
  for (const Vector2d& point : points) {
    if (point.x() < 20.) largest = std::max(largest, std::abs(point.y()));
  }
  EXPECT_LE(largest, 0.3);
  EXPECT_GT(largest, 0.);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
