// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/scan_conversion.h"

#include <limits>

#include "cartographer_ext/map/host_types.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

io::LaserScan FourBeams() {
  io::LaserScan scan;
  scan.time = 5000000000;
  scan.angle_min = 0.;
  scan.angle_increment = kPi / 2.;
  scan.range_min = 0.1;
  scan.range_max = 10.;
  scan.ranges = {1.f, 2.f, 3.f, 4.f};
  return scan;
}

TEST(ScanConversionTest, PutsPointsIntoTheTrackingFrame) {
  io::LaserScan scan = FourBeams();
  scan.laser_pose = Pose2(0.5, 0.25, kPi / 2.);
  const auto data = ToTimedPointCloudData(scan, 0., kInfinity);
  EXPECT_EQ(data.time, ToHostTime(scan.time));
  EXPECT_EQ(data.origin, Eigen::Vector3f(0.5f, 0.25f, 0.f));
  ASSERT_EQ(data.ranges.size(), 4u);
  // The first beam points along the laser's x axis, the robot's y axis.
  EXPECT_TRUE(data.ranges[0].position.isApprox(
      Eigen::Vector3f(0.5f, 1.25f, 0.f), 1e-6f));
  EXPECT_TRUE(data.ranges[1].position.isApprox(
      Eigen::Vector3f(-1.5f, 0.25f, 0.f), 1e-6f));
}

TEST(ScanConversionTest, DropsWhatTheLaserDidNotSee) {
  io::LaserScan scan = FourBeams();
  scan.ranges = {std::numeric_limits<float>::quiet_NaN(),
                 std::numeric_limits<float>::infinity(), 0.05f, 11.f};
  EXPECT_TRUE(ToTimedPointCloudData(scan, 0., kInfinity).ranges.empty());
  scan.range_max = kInfinity;
  EXPECT_EQ(ToTimedPointCloudData(scan, 0., kInfinity).ranges.size(), 1u);
}

TEST(ScanConversionTest, AppliesTheLimitsOfTheConfiguration) {
  const auto data = ToTimedPointCloudData(FourBeams(), 1.5, 3.);
  ASSERT_EQ(data.ranges.size(), 2u);
  EXPECT_NEAR(data.ranges[0].position.norm(), 2., 1e-6);
  EXPECT_NEAR(data.ranges[1].position.norm(), 3., 1e-6);
}

TEST(ScanConversionTest, TimesCountBackFromTheLastBeam) {
  io::LaserScan scan = FourBeams();
  for (const auto& point : ToTimedPointCloudData(scan, 0., kInfinity).ranges) {
    EXPECT_EQ(point.time, 0.f);
  }
  scan.time_increment = 0.01;
  scan.ranges[3] = 100.f;
  const auto data = ToTimedPointCloudData(scan, 0., kInfinity);
  ASSERT_EQ(data.ranges.size(), 3u);
  EXPECT_FLOAT_EQ(data.ranges[0].time, -0.03f);
  EXPECT_FLOAT_EQ(data.ranges[2].time, -0.01f);
}

TEST(ScanConversionTest, PointsKeepTheirTimes) {
  io::LaserScan scan;
  scan.range_max = 10.;
  scan.points = {{1., 0.}, {0., 20.}, {0., 2.}};
  scan.point_times = {-0.1f, -0.05f, 0.f};
  const auto data = ToTimedPointCloudData(scan, 0., 10.);
  ASSERT_EQ(data.ranges.size(), 2u);
  EXPECT_EQ(data.ranges[0].time, -0.1f);
  EXPECT_EQ(data.ranges[1].time, 0.f);
}

TEST(HostTypesTest, StampsSurviveTheRoundTrip) {
  for (const io::TimeNs time : {0LL, 90239599000LL, 976052857337530000LL}) {
    EXPECT_EQ(FromHostTime(ToHostTime(time)), time);
  }
  // Rounded to the host's ticks of 100 ns.
  EXPECT_EQ(FromHostTime(ToHostTime(149)), 100);
  EXPECT_EQ(FromHostTime(ToHostTime(150)), 200);
  EXPECT_EQ(FromHostTime(ToHostTime(-149)), -100);
}

TEST(HostTypesTest, UnixEpochInUniversalTicks) {
  EXPECT_EQ(cartographer::common::ToUniversal(ToHostTime(0)),
            621355968000000000LL);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
