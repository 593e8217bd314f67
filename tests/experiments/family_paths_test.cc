// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/experiments/family_paths.h"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace experiments {
namespace {

TEST(FamilyPathsTest, DrivesAlongAnArc) {
  Path path;
  path.Add(Pose2(1., 2., 0.), 0, 0);
  // A quarter of a circle of 4 m to the left.
  Drive(2. * kPi, 0.25, 0.5, 3, 7, &path);
  ASSERT_EQ(path.poses.size(), 14u);
  EXPECT_EQ(path.floors.back(), 3);
  EXPECT_EQ(path.robots.back(), 7);
  EXPECT_NEAR(path.poses.back().theta, kPi / 2., 1e-9);
  // Chords are as long as the arc, so the circle is a little larger.
  EXPECT_NEAR(path.poses.back().x, 5., 0.01);
  EXPECT_NEAR(path.poses.back().y, 6., 0.01);
}

TEST(FamilyPathsTest, RingsCloseAfterEachLap) {
  Random random(1);
  // 12 m of radius and 0.5 m of step: 75 steps to each half circle.
  const Path path = Rings(2, 12., 0.5, 2., &random);
  ASSERT_GT(path.poses.size(), 600u);
  for (const size_t k : {300u, 600u}) {
    EXPECT_LT(
        (path.poses[k].translation() - path.poses[0].translation()).norm(),
        1e-6);
  }
  EXPECT_GT(
      (path.poses[150].translation() - path.poses[0].translation()).norm(),
      20.);
}

TEST(FamilyPathsTest, AWalkStaysWithinItsStreets) {
  Random random(2);
  Path path;
  StreetWalker walker(3, 10., 1., &random, &path);
  walker.Begin(1, 1, 0, 0);
  walker.Walk(40);
  walker.WalkHome();
  for (const Pose2& pose : path.poses) {
    EXPECT_GE(std::min(pose.x, pose.y), -1e-6);
    EXPECT_LE(std::max(pose.x, pose.y), 30. + 1e-6);
    // On a street: one coordinate is a multiple of the block.
    const auto off = [](const double value) {
      return std::abs(value - 10. * std::round(value / 10.));
    };
    EXPECT_LT(std::min(off(pose.x), off(pose.y)), 1e-6);
  }
  EXPECT_LT(path.poses.back().translation().norm(), 1e-6);
}

TEST(FamilyPathsTest, ArmsOfAStarEndWhereTheyBegin) {
  Random random(3);
  const Path path = Star(5, 30., 1., &random);
  int at_centre = 0;
  for (const Pose2& pose : path.poses) {
    at_centre += pose.translation().norm() < 1e-6;
  }
  // The start, and each arm's end before and after its turn.
  EXPECT_EQ(at_centre, 11);
}

}  // namespace
}  // namespace experiments
}  // namespace cartographer_ext
