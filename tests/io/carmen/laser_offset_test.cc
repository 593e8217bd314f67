// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/carmen/laser_offset.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

TEST(LaserOffsetTest, FindsTheConstantOffsetDespiteRounding) {
  std::vector<Pose2> offsets(100, Pose2(0.2, -0.1, 0.5));
  for (int i = 0; i < 40; ++i) offsets[i].x += 0.01;
  for (int i = 60; i < 100; ++i) offsets[i].x -= 0.01;
  Pose2 offset;
  ASSERT_TRUE(FindConstantOffset(offsets, &offset));
  EXPECT_DOUBLE_EQ(offset.x, 0.2);
  EXPECT_DOUBLE_EQ(offset.y, -0.1);
  EXPECT_NEAR(offset.theta, 0.5, 1e-12);
}

TEST(LaserOffsetTest, OneOfAHundredMayDiffer) {
  std::vector<Pose2> offsets(200, Pose2(0.2, 0., 0.));
  offsets[0] = offsets[1] = Pose2(3., 0., 0.);
  Pose2 offset;
  EXPECT_TRUE(FindConstantOffset(offsets, &offset));
  offsets[2] = offsets[0];
  EXPECT_FALSE(FindConstantOffset(offsets, &offset));
}

// A laser that looks backwards: its angle is just below and just above pi.
TEST(LaserOffsetTest, AnglesMayWrap) {
  std::vector<Pose2> offsets(50, Pose2(-0.3, 0., M_PI - 0.005));
  for (int i = 0; i < 20; ++i) offsets[i].theta = -M_PI + 0.005;
  Pose2 offset;
  ASSERT_TRUE(FindConstantOffset(offsets, &offset));
  EXPECT_NEAR(std::abs(offset.theta), M_PI, 0.006);
}

TEST(LaserOffsetTest, RefusesWhatIsNoMounting) {
  Pose2 offset;
  std::vector<Pose2> drifting;
  for (int i = 0; i < 100; ++i) drifting.emplace_back(0.01 * i, 0., 0.);
  EXPECT_FALSE(FindConstantOffset(drifting, &offset));
  EXPECT_FALSE(FindConstantOffset(
      std::vector<Pose2>(10, Pose2(kMaxLaserOffset + 0.1, 0., 0.)), &offset));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
