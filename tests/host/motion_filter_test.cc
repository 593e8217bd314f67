// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/motion_filter.h"

#include "gtest/gtest.h"
#include "tests/host/mapping_test_helpers.h"

namespace cartographer {
namespace mapping {
namespace {

class MotionFilterTest : public ::testing::Test {
 protected:
  MotionFilterTest() : filter_(Options()) {}

  static proto::MotionFilterOptions Options() {
    const auto lua = test::Lua(
        "return { max_time_seconds = 0.5, max_distance_meters = 0.2,"
        " max_angle_radians = 2. }");
    return CreateMotionFilterOptions(lua.get());
  }
  bool IsSimilar(const double seconds, const double x, const double angle) {
    return filter_.IsSimilar(
        common::FromUniversal(0) + common::FromSeconds(seconds),
        transform::Rigid3d(Eigen::Vector3d(x, 0., 0.),
                           Eigen::Quaterniond(Eigen::AngleAxisd(
                               angle, Eigen::Vector3d::UnitZ()))));
  }
  MotionFilter filter_;
};

TEST_F(MotionFilterTest, TheFirstPoseDiffers) {
  EXPECT_FALSE(IsSimilar(42., 0., 0.));
  EXPECT_TRUE(IsSimilar(42., 0., 0.));
}

TEST_F(MotionFilterTest, Time) {
  EXPECT_FALSE(IsSimilar(0., 0., 0.));
  EXPECT_TRUE(IsSimilar(0.5, 0., 0.));
  EXPECT_FALSE(IsSimilar(0.51, 0., 0.));
  EXPECT_TRUE(IsSimilar(1.0, 0., 0.));
}

TEST_F(MotionFilterTest, DistanceAddsUp) {
  EXPECT_FALSE(IsSimilar(0., 0., 0.));
  EXPECT_TRUE(IsSimilar(0., 0.15, 0.));
  EXPECT_FALSE(IsSimilar(0., 0.25, 0.));
  EXPECT_TRUE(IsSimilar(0., 0.25 - 0.19, 0.));
}

TEST_F(MotionFilterTest, Angle) {
  EXPECT_FALSE(IsSimilar(0., 0., 0.));
  EXPECT_TRUE(IsSimilar(0., 0., -1.9));
  EXPECT_FALSE(IsSimilar(0., 0., 2.1));
  // Along the shorter arc.
  EXPECT_TRUE(IsSimilar(0., 0., 2.1 + 6.2));
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
