// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/navigator_input.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// Three beams to the left, ahead and to the right of a laser that looks to the
// left of the robot: an echo, too far, too near.
TEST(NavigatorInputTest, SeparatesEchoesFromMisses) {
  io::LaserScan scan;
  scan.laser_pose = Pose2(0.5, 0.25, kPi / 2.);
  scan.angle_min = -kPi / 2.;
  scan.angle_increment = kPi / 2.;
  scan.range_min = 0.1;
  scan.range_max = 8.;
  scan.ranges = {3.f, 9.f, 0.05f};
  const NavigatorScan result = ToNavigatorScan(scan);
  EXPECT_EQ(result.laser, Eigen::Vector2d(0.5, 0.25));
  ASSERT_EQ(result.echoes.size(), 1u);
  EXPECT_LT((result.echoes[0] - Eigen::Vector2d(3.5, 0.25)).norm(), 1e-9);
  // Whatever the reason, two metres of the beam are free.
  ASSERT_EQ(result.free_ends.size(), 2u);
  EXPECT_LT((result.free_ends[0] - Eigen::Vector2d(0.5, 2.25)).norm(), 1e-9);
  EXPECT_LT((result.free_ends[1] - Eigen::Vector2d(-1.5, 0.25)).norm(), 1e-9);
}

}  // namespace
}  // namespace navigation
}  // namespace cartographer_ext
