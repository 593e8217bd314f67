// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros_messages.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gtest/gtest.h"
#include "tests/io/ros/message_bytes.h"
#include "tests/mutation.h"

namespace cartographer_ext {
namespace io {
namespace {

using test::Bytes;

std::string LaserScanBytes(const std::vector<float>& ranges) {
  return Bytes()
      .Header(10, 500000000, "/laser")
      // angle_min, _max, _increment, time_increment, scan_time, range_min, _max
      .Floats({-1.f, 1.f, 0.5f, 0.25f, 0.1f, 0.1f, 30.f})
      .Add(static_cast<uint32_t>(ranges.size()))
      .Floats(ranges)
      .Add(uint32_t{1})
      .Add(99.f)
      .data();
}

TEST(RosMessagesTest, LaserScan) {
  RosHeader header;
  LaserScan scan;
  ASSERT_TRUE(DecodeLaserScan(RosEncoding::kRos1,
                              LaserScanBytes({1.f, 2.f, 3.f}), &header, &scan));
  EXPECT_EQ(header.time, 10500000000);
  EXPECT_EQ(header.frame, "laser");
  EXPECT_EQ(scan.time, 11000000000);  // of the last beam
  EXPECT_EQ(scan.angle_min, -1.);
  EXPECT_EQ(scan.angle_increment, 0.5);
  EXPECT_EQ(scan.time_increment, 0.25);
  // A reading of range_max is "no return".
  EXPECT_LT(static_cast<float>(scan.range_max), 30.f);
  EXPECT_NEAR(scan.range_max, 30., 1e-5);
  EXPECT_EQ(scan.ranges, (std::vector<float>{1.f, 2.f, 3.f}));
  EXPECT_FALSE(
      DecodeLaserScan(RosEncoding::kRos1, LaserScanBytes({}), &header, &scan));
  // More than a full turn.
  EXPECT_FALSE(DecodeLaserScan(RosEncoding::kRos1,
                               LaserScanBytes(std::vector<float>(20, 1.f)),
                               &header, &scan));
}

TEST(RosMessagesTest, MultiEchoLaserScan) {
  const std::string data = Bytes()
                               .Header(10, 0, "laser")
                               .Floats({-1.f, 1.f, 0.5f, 0.f, 0.f, 0.1f, 30.f})
                               .Add(uint32_t{2})
                               .Add(uint32_t{2})
                               .Floats({4.f, 5.f})
                               .Add(uint32_t{0})
                               .Add(uint32_t{1})
                               .Add(uint32_t{1})
                               .Add(7.f)
                               .data();
  RosHeader header;
  LaserScan scan;
  ASSERT_TRUE(
      DecodeMultiEchoLaserScan(RosEncoding::kRos1, data, &header, &scan));
  ASSERT_EQ(scan.ranges.size(), 2u);
  EXPECT_EQ(scan.ranges[0], 4.f);
  EXPECT_TRUE(std::isnan(scan.ranges[1]));
  EXPECT_EQ(scan.echoes[0], (std::vector<float>{4.f, 5.f}));
}

std::string OdometryBytes(const std::vector<double>& pose) {
  return Bytes()
      .Header(1, 2, "odom")
      .Text("base_link")
      .Doubles(pose)
      .Doubles(std::vector<double>(36 + 6 + 36, 0.))
      .data();
}

TEST(RosMessagesTest, Odometry) {
  RosHeader header;
  std::string child;
  Eigen::Isometry3d pose;
  ASSERT_TRUE(DecodeOdometry(RosEncoding::kRos1,
                             OdometryBytes({1., 2., 3., 0., 0., 0.6, 0.8}),
                             &header, &child, &pose));
  EXPECT_EQ(header.time, 1000000002);
  EXPECT_EQ(child, "base_link");
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1., 2., 3.)));
  EXPECT_NEAR(std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)),
              2. * std::atan2(0.6, 0.8), 1e-12);
  // All zero stands for no rotation.
  ASSERT_TRUE(DecodeOdometry(RosEncoding::kRos1,
                             OdometryBytes({1., 2., 3., 0., 0., 0., 0.}),
                             &header, &child, &pose));
  EXPECT_TRUE(pose.linear().isIdentity());
  EXPECT_FALSE(DecodeOdometry(RosEncoding::kRos1,
                              OdometryBytes({1., 2., 3., 0., 0., 0., 0.5}),
                              &header, &child, &pose));
  EXPECT_FALSE(DecodeOdometry(
      RosEncoding::kRos1, OdometryBytes({std::nan(""), 2., 3., 0., 0., 0., 1.}),
      &header, &child, &pose));
}

TEST(RosMessagesTest, Imu) {
  const auto bytes = [](double rate) {
    return Bytes()
        .Header(3, 0, "imu")
        .Doubles({0., 0., 0., 1.})
        .Doubles(std::vector<double>(9, 0.))
        .Doubles({0.1, 0.2, rate})
        .Doubles(std::vector<double>(9, 0.))
        .Doubles({1., 2., 9.8})
        .Doubles(std::vector<double>(9, 0.))
        .data();
  };
  RosHeader header;
  ImuReading reading;
  ASSERT_TRUE(DecodeImu(RosEncoding::kRos1, bytes(0.3), &header, &reading));
  EXPECT_EQ(reading.time, 3000000000);
  EXPECT_EQ(reading.angular_velocity, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(reading.linear_acceleration, Eigen::Vector3d(1., 2., 9.8));
  EXPECT_FALSE(
      DecodeImu(RosEncoding::kRos1, bytes(std::nan("")), &header, &reading));
}

TEST(RosMessagesTest, Transforms) {
  const std::string data = Bytes()
                               .Add(uint32_t{2})
                               .Header(1, 0, "/odom")
                               .Text("/base")
                               .Doubles({1., 0., 0., 0., 0., 0., 1.})
                               .Header(1, 0, "base")
                               .Text("laser")
                               .Doubles({2., 0., 0., 0., 0., 0., 1.})
                               .data();
  std::vector<RosTransform> transforms;
  ASSERT_TRUE(DecodeTransforms(RosEncoding::kRos1, data, &transforms));
  ASSERT_EQ(transforms.size(), 2u);
  EXPECT_EQ(transforms[0].header.frame, "odom");
  EXPECT_EQ(transforms[0].child_frame, "base");
  EXPECT_EQ(transforms[1].pose.translation().x(), 2.);
  // A count that the message cannot hold.
  std::string lying = data;
  lying[3] = '\x7f';
  EXPECT_FALSE(DecodeTransforms(RosEncoding::kRos1, lying, &transforms));
}

TEST(RosMessagesTest, PointCloud2) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const RosEncoding encoding : {RosEncoding::kRos1, RosEncoding::kCdr}) {
    const std::string data = test::PointCloud2Bytes(
        encoding, 10, "/lidar",
        {{1.f, 2.f, 0.5f}, {nan, nan, nan}, {-3.f, 0.f, 0.5f}});
    RosHeader header;
    RosPointCloud cloud;
    ASSERT_TRUE(DecodePointCloud2(encoding, data, &header, &cloud));
    EXPECT_EQ(header.time, 10000000000);
    EXPECT_EQ(header.frame, "lidar");
    // Points without a return are left out.
    ASSERT_EQ(cloud.points.size(), 2u);
    EXPECT_TRUE(cloud.times.empty());
    EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1., 2., 0.5));
    EXPECT_EQ(cloud.points[1], Eigen::Vector3d(-3., 0., 0.5));
    for (size_t size = 0; size + 8 < data.size(); ++size) {
      EXPECT_FALSE(
          DecodePointCloud2(encoding, data.substr(0, size), &header, &cloud));
    }
    test::ForEachMutation(data, [encoding](const std::string& damaged) {
      RosHeader damaged_header;
      RosPointCloud damaged_cloud;
      DecodePointCloud2(encoding, damaged, &damaged_header, &damaged_cloud);
    });
  }
}

template <typename T>
std::string Raw(const T value) {
  return test::Bytes().Add(value).data();
}

std::vector<double> PointTimes(const std::string& field, const uint8_t type,
                               const std::vector<std::string>& times) {
  RosHeader header;
  RosPointCloud cloud;
  const std::string data = test::PointCloud2Bytes(
      RosEncoding::kRos1, 1000000010, "lidar",
      {{1.f, 0.f, 0.f}, {0.f, 2.f, 0.f}}, field, type, times);
  EXPECT_TRUE(DecodePointCloud2(RosEncoding::kRos1, data, &header, &cloud));
  EXPECT_EQ(cloud.points.size(), 2u);
  return cloud.times;
}

TEST(RosMessagesTest, TimesOfPoints) {
  constexpr uint8_t kUint16 = 4, kInt32 = 5, kUint32 = 6, kFloat32 = 7,
                    kFloat64 = 8;
  using ::testing::DoubleNear;
  using ::testing::ElementsAre;
  using ::testing::IsEmpty;
  const auto times = ElementsAre(DoubleNear(0.05, 1e-6), DoubleNear(0.1, 1e-6));
  EXPECT_THAT(PointTimes("t", kUint32,
                         {Raw(uint32_t{50000000}), Raw(uint32_t{100000000})}),
              times);
  EXPECT_THAT(PointTimes("offset_time", kInt32,
                         {Raw(int32_t{50000000}), Raw(int32_t{100000000})}),
              times);
  EXPECT_THAT(PointTimes("time", kFloat32, {Raw(0.05f), Raw(0.1f)}), times);
  EXPECT_THAT(PointTimes("timestamp", kFloat64, {Raw(0.05), Raw(0.1)}), times);
  EXPECT_THAT(PointTimes("timestamp", kFloat64,
                         {Raw(1000000010.05), Raw(1000000010.1)}),
              times);
  EXPECT_THAT(PointTimes("timestamp", kFloat64,
                         {Raw(1000000010.05e9), Raw(1000000010.1e9)}),
              times);
  // Before the stamp of the message, as some drivers have it.
  EXPECT_THAT(PointTimes("time", kFloat32, {Raw(-0.1f), Raw(0.f)}),
              ElementsAre(DoubleNear(-0.1, 1e-6), 0.));
  // In another unit, not a number, another type, another field.
  EXPECT_THAT(PointTimes("time", kFloat32, {Raw(50.f), Raw(100.f)}), IsEmpty());
  EXPECT_THAT(
      PointTimes("time", kFloat32,
                 {Raw(0.05f), Raw(std::numeric_limits<float>::quiet_NaN())}),
      IsEmpty());
  EXPECT_THAT(PointTimes("time", kUint16, {Raw(uint16_t{1}), Raw(uint16_t{2})}),
              IsEmpty());
  EXPECT_THAT(PointTimes("ring", kFloat32, {Raw(0.05f), Raw(0.1f)}), IsEmpty());
}

TEST(RosMessagesTest, TooShortOrTooLongIsRefused) {
  const std::string scan = LaserScanBytes({1.f, 2.f, 3.f});
  RosHeader header;
  LaserScan decoded;
  for (size_t size = 0; size < scan.size(); ++size) {
    EXPECT_FALSE(DecodeLaserScan(RosEncoding::kRos1, scan.substr(0, size),
                                 &header, &decoded));
  }
  EXPECT_FALSE(
      DecodeLaserScan(RosEncoding::kRos1, scan + "x", &header, &decoded));
}

TEST(RosMessagesTest, SurvivesMutations) {
  const std::string samples[] = {LaserScanBytes({1.f, 2.f, 3.f}),
                                 OdometryBytes({1., 2., 3., 0., 0., 0.6, 0.8})};
  for (const std::string& sample : samples) {
    test::ForEachMutation(sample, [](const std::string& damaged) {
      RosHeader header;
      LaserScan scan;
      ImuReading imu;
      std::string child;
      Eigen::Isometry3d pose;
      std::vector<RosTransform> transforms;
      DecodeLaserScan(RosEncoding::kRos1, damaged, &header, &scan);
      DecodeMultiEchoLaserScan(RosEncoding::kRos1, damaged, &header, &scan);
      DecodeImu(RosEncoding::kRos1, damaged, &header, &imu);
      DecodeOdometry(RosEncoding::kRos1, damaged, &header, &child, &pose);
      DecodeTransforms(RosEncoding::kRos1, damaged, &transforms);
    });
  }
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
