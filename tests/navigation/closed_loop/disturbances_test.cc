// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/disturbances.h"

#include <algorithm>

#include "cartographer_ext/navigation/closed_loop/true_plan.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

class DisturbancesTest : public testing::Test {
 protected:
  DisturbancesTest() : plan_(Walls(), {}) {}

  // Two rooms of 12 m by 5 m with two doors between them.
  static std::vector<simulation::Segment> Walls() {
    const auto p = [](const double x, const double y) {
      return Eigen::Vector2d(x, y);
    };
    return {{p(0, 0), p(24, 0)},    {p(24, 0), p(24, 5)},
            {p(24, 5), p(0, 5)},    {p(0, 5), p(0, 0)},
            {p(12, 0), p(12, 0.5)}, {p(12, 1.9), p(12, 3.1)},
            {p(12, 4.5), p(12, 5)}};
  }

  const simulation::RayCaster plan_;
  const std::vector<std::vector<Eigen::Vector2d>> legs_ = {
      {{1., 1.2}, {23., 1.2}}, {{23., 1.2}, {1., 1.2}}};
};

TEST_F(DisturbancesTest, ComeToBeNearTheRobotButNotTooNear) {
  DisturbanceOptions options;
  options.obstacles = 3;
  options.crossings = 2;
  auto disturbances = Disturbances::Create(plan_, legs_, options, 4);
  ASSERT_TRUE(disturbances.ok()) << disturbances.status();
  EXPECT_EQ(disturbances->all().size(), 5u);
  EXPECT_TRUE(disturbances->stationary().empty());
  size_t most_moving = 0, before = 0;
  std::vector<Eigen::Vector2d> seen;
  for (double time = 0.; time < 40.; time += 0.05) {
    const Eigen::Vector2d robot(1. + 0.55 * time, 1.2);
    disturbances->Update(time, robot);
    const auto& stationary = disturbances->stationary();
    // A new one is no nearer than it may be.
    for (size_t i = 0; i < stationary.size() && stationary.size() > before;
         ++i) {
      const double distance =
          (stationary[i].center - robot).norm() - stationary[i].radius;
      if (std::find_if(seen.begin(), seen.end(), [&](const auto& center) {
            return center == stationary[i].center;
          }) == seen.end()) {
        EXPECT_GE(distance, options.min_distance);
        seen.push_back(stationary[i].center);
      }
    }
    before = stationary.size();
    most_moving = std::max(most_moving, disturbances->moving().size());
  }
  EXPECT_EQ(disturbances->stationary().size(), 3u);
  EXPECT_GE(most_moving, 1u);
  // Those who cross are gone in the end.
  for (double time = 40.; time < 60.; time += 0.1) {
    disturbances->Update(time, {23., 1.2});
  }
  EXPECT_TRUE(disturbances->moving().empty());
}

TEST_F(DisturbancesTest, NothingAppearsWithinReach) {
  DisturbanceOptions options;
  options.obstacles = 1;
  auto disturbances = Disturbances::Create(plan_, legs_, options, 7);
  ASSERT_TRUE(disturbances.ok());
  const simulation::Disc disc = disturbances->all()[0].discs[0];
  disturbances->Update(0., disc.center + Eigen::Vector2d(1., 0.));
  EXPECT_TRUE(disturbances->stationary().empty());
  disturbances->Update(1., disc.center + Eigen::Vector2d(2.5, 0.));
  EXPECT_EQ(disturbances->stationary().size(), 1u);
  // And stays.
  disturbances->Update(2., disc.center + Eigen::Vector2d(20., 0.));
  EXPECT_EQ(disturbances->stationary().size(), 1u);
}

TEST_F(DisturbancesTest, ADoorLeavesAnotherPath) {
  // Two parallel corridors of 2 m that meet at both ends.
  const auto p = [](const double x, const double y) {
    return Eigen::Vector2d(x, y);
  };
  const simulation::RayCaster corridors({{p(0, 0), p(20, 0)},
                                         {p(20, 0), p(20, 4.2)},
                                         {p(20, 4.2), p(0, 4.2)},
                                         {p(0, 4.2), p(0, 0)},
                                         {p(2, 2), p(18, 2)},
                                         {p(18, 2), p(18, 2.2)},
                                         {p(18, 2.2), p(2, 2.2)},
                                         {p(2, 2.2), p(2, 2)}},
                                        {});
  DisturbanceOptions options;
  options.doors = 1;
  const auto one =
      Disturbances::Create(corridors, {{{1., 1.}, {19., 1.}}}, options, 3);
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_GT(one->all()[0].discs.size(), 10u);
  // With both corridors closed the goal could not be reached.
  options.doors = 20;
  const auto too_many = Disturbances::Create(
      corridors, {{{1., 1.}, {19., 1.}, {19., 3.2}, {1., 3.2}}}, options, 3);
  ASSERT_FALSE(too_many.ok());
  EXPECT_NE(too_many.status().message().find("there is room for"),
            absl::string_view::npos);
}

TEST_F(DisturbancesTest, AnObstacleLeavesAWayBesideIt) {
  // Doors of 1.8 m, six metres apart: by the other one it is 9 m farther.
  const auto p = [](const double x, const double y) {
    return Eigen::Vector2d(x, y);
  };
  const simulation::RayCaster rooms({{p(0, 0), p(24, 0)},
                                     {p(24, 0), p(24, 9)},
                                     {p(24, 9), p(0, 9)},
                                     {p(0, 9), p(0, 0)},
                                     {p(12, 0), p(12, 0.3)},
                                     {p(12, 2.1), p(12, 6.9)},
                                     {p(12, 8.7), p(12, 9)}},
                                    {});
  DisturbanceOptions options;
  options.obstacles = 1;
  const double radius = options.robot_radius + 0.5 * options.spare_width;
  for (int seed = 1; seed <= 30; ++seed) {
    auto disturbances =
        Disturbances::Create(rooms, {{{9.9, 1.2}, {14.1, 1.2}}}, options, seed);
    if (!disturbances.ok()) continue;
    const auto path =
        ShortestPath(rooms.segments(), disturbances->all()[0].discs, radius,
                     p(9.9, 1.2), p(14.1, 1.2));
    ASSERT_TRUE(path.ok() && path->found());
    EXPECT_LT(path->length, 5.5) << seed;
  }
}

TEST_F(DisturbancesTest, DrawsAnewWhereTheFirstOnesLeaveNoRoom) {
  // On a path of 11.5 m between goals that keep 1.5 m: four at 2 m fit, unless
  // the first ones take up the room.
  const simulation::RayCaster corridor(
      {{{-2., -2.}, {15., -2.}}, {{-2., 2.}, {15., 2.}}}, {});
  DisturbanceOptions options;
  options.obstacles = 4;
  for (int seed = 1; seed <= 30; ++seed) {
    EXPECT_TRUE(
        Disturbances::Create(corridor, {{{0., 0.}, {11.5, 0.}}}, options, seed)
            .ok())
        << seed;
  }
}

TEST_F(DisturbancesTest, TheSeedDecides) {
  DisturbanceOptions options;
  options.obstacles = 2;
  const auto place = [&](const uint64_t seed) {
    return Disturbances::Create(plan_, legs_, options, seed)
        ->all()[0]
        .discs[0]
        .center.x();
  };
  EXPECT_EQ(place(1), place(1));
  EXPECT_NE(place(1), place(2));
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
