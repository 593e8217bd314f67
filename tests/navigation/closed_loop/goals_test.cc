// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/goals.h"

#include "gtest/gtest.h"
#include "tests/navigation/test_maps.h"

namespace cartographer_ext {
namespace navigation {
namespace {

TEST(GoalsTest, ParsesPairs) {
  const auto goals = ParseGoals("1,2;-3.5,4e1");
  ASSERT_TRUE(goals.ok());
  ASSERT_EQ(goals->size(), 2u);
  EXPECT_EQ((*goals)[1], Eigen::Vector2d(-3.5, 40.));
  for (const char* bad : {"", "1", "1,2,3", "1,x", "1,2;", "nan,1", "1;2"}) {
    const auto error = ParseGoals(bad);
    ASSERT_FALSE(error.ok()) << bad;
    EXPECT_NE(error.status().message().find("is not X,Y"),
              absl::string_view::npos);
  }
}

TEST(GoalsTest, DrawsReachableGoalsAndReturns) {
  io::OccupancyMap map = RoomMap(12., 8.);
  FillBox(8., 0., 8.1, 8., 1.f, &map);  // the right part cannot be reached
  const Costmap costmap = MakeCostmap(map);
  const Eigen::Vector2d start(1., 1.);
  const auto goals = DrawGoals(costmap, start, 4, 3);
  ASSERT_TRUE(goals.ok());
  ASSERT_EQ(goals->size(), 4u);
  EXPECT_EQ(goals->back(), start);
  for (size_t i = 0; i != 3; ++i) {
    EXPECT_LT((*goals)[i].x(), 8.);
    for (size_t j = 0; j != i; ++j) {
      EXPECT_GT(((*goals)[i] - (*goals)[j]).norm(), 1.);
    }
  }
  EXPECT_NE((*DrawGoals(costmap, start, 4, 4))[0], (*goals)[0]);
  EXPECT_EQ((*DrawGoals(costmap, start, 4, 3))[0], (*goals)[0]);
}

TEST(GoalsTest, SaysWhenThereIsNoRoom) {
  const Costmap costmap = MakeCostmap(RoomMap(1., 1.));
  EXPECT_FALSE(DrawGoals(costmap, {0.5, 0.5}, 4, 1).ok());
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
