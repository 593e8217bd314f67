// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/true_plan.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

using simulation::Disc;
using simulation::Segment;

std::vector<Segment> Box(const double x0, const double y0, const double x1,
                         const double y1) {
  const Eigen::Vector2d a(x0, y0), b(x1, y0), c(x1, y1), d(x0, y1);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

TEST(TruePlanTest, ShortestPathGoesAroundADisc) {
  const std::vector<Disc> discs = {{Eigen::Vector2d(5., 3.), 0.5}};
  const auto path =
      ShortestPath(Box(0., 0., 10., 6.), discs, 0.25, {2., 3.}, {8., 3.});
  ASSERT_TRUE(path.ok() && path->found());
  // Two tangents and an arc of a circle of 0.75 m.
  const double tangent = std::sqrt(9. - 0.75 * 0.75);
  const double arc = 0.75 * (kPi - 2. * std::acos(0.75 / 3.));
  EXPECT_NEAR(path->length, 2. * tangent + arc, 0.12);
  const auto closed =
      ShortestPath(Box(0., 0., 10., 6.), {}, 0.25, {2., 3.}, {12., 3.});
  ASSERT_TRUE(closed.ok());
  EXPECT_FALSE(closed->found());
  EXPECT_FALSE(ShortestPath({}, {}, 0.25, {0., 0.}, {1., 0.}).ok());
}

TEST(TruePlanTest, AlignsAMapToTheWorld) {
  std::vector<Segment> segments = Box(0., 0., 10., 6.);
  for (const Segment& segment : Box(3., 2., 4., 3.5)) {
    segments.push_back(segment);
  }
  const simulation::RayCaster plan(segments, {});
  const Pose2 map_from_world(-2., 1.5, 0.3);
  // The walls as cells of a map that is turned against the world.
  io::OccupancyMap map =
      io::OccupancyMap::Make(400, 400, 0.05, Pose2(-6., -2., 0.));
  for (const Segment& segment : segments) {
    for (double ratio = 0.; ratio <= 1.; ratio += 0.002) {
      const Eigen::Vector2d p =
          map_from_world *
          Eigen::Vector2d(segment.a + ratio * (segment.b - segment.a));
      const int x = std::floor((p.x() + 6.) / 0.05);
      const int y = std::floor((p.y() + 2.) / 0.05);
      if (x >= 0 && y >= 0 && x < 400 && y < 400) map.at(x, y) = 1.f;
    }
  }
  const Pose2 guess(-1.9, 1.35, 0.32);
  const Pose2 aligned = AlignMapToWorld(map, 0.5, plan, guess);
  EXPECT_NEAR(aligned.x, map_from_world.x, 0.01);
  EXPECT_NEAR(aligned.y, map_from_world.y, 0.01);
  EXPECT_NEAR(aligned.theta, map_from_world.theta, 0.002);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
