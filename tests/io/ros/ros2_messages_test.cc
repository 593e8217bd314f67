// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros2_messages.h"

#include <cmath>
#include <vector>

#include "cartographer_ext/io/ros/ros_messages.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/io/ros/ros2_sample.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Ros2MessagesTest, TransformByHand) {
  // Sequence length, stamp, "a" and "bc" with their final zeros, then doubles
  // aligned to eight bytes counted from behind the encapsulation.
  const std::string bytes =
      EncodeTransform(3000000007, "a", "bc", Pose2(1., 2., 0.));
  ASSERT_EQ(bytes.size(), 4u + 4 + 8 + (4 + 2 + 2) + (4 + 3 + 5) + 7 * 8);
  EXPECT_EQ(bytes.substr(0, 20),
            std::string("\0\1\0\0\1\0\0\0\3\0\0\0\7\0\0\0\2\0\0\0", 20));
  EXPECT_EQ(bytes.substr(20, 2), std::string("a\0", 2));
  EXPECT_EQ(bytes.substr(24, 7), std::string("\3\0\0\0bc\0", 7));
  EXPECT_EQ(bytes.substr(36, 8),
            std::string("\0\0\0\0\0\0\xf0\x3f",
                        8));  // 1. at 32 from behind the encapsulation
}

TEST(Ros2MessagesTest, EveryLengthOfFrameNamesIsAligned) {
  std::string frame;
  for (int i = 0; i < 20; ++i) {
    frame += 'f';
    OdometryReading reading;
    reading.time = 12345678901234567;
    reading.pose = Pose2(1., -2., 0.5);
    RosHeader header;
    std::string child;
    Eigen::Isometry3d pose;
    ASSERT_TRUE(
        DecodeOdometry(RosEncoding::kCdr,
                       EncodeOdometry(reading, 1., 2., frame, frame + "/child"),
                       &header, &child, &pose));
    EXPECT_EQ(header.time, reading.time);
    EXPECT_EQ(header.frame, frame);
    EXPECT_EQ(child, frame + "/child");
    EXPECT_DOUBLE_EQ(pose.translation().y(), -2.);
    EXPECT_NEAR(std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)), 0.5,
                1e-12);
    std::vector<RosTransform> transforms;
    ASSERT_TRUE(DecodeTransforms(
        RosEncoding::kCdr, EncodeTransform(7, frame, "x", Pose2(3., 4., 0.)),
        &transforms));
    ASSERT_EQ(transforms.size(), 1u);
    EXPECT_DOUBLE_EQ(transforms[0].pose.translation().x(), 3.);
    ImuReading imu, decoded;
    imu.time = 5;
    imu.angular_velocity = Eigen::Vector3d(1., 2., 3.);
    imu.linear_acceleration = Eigen::Vector3d(4., 5., 6.);
    ASSERT_TRUE(
        DecodeImu(RosEncoding::kCdr, EncodeImu(imu, frame), &header, &decoded));
    EXPECT_EQ(decoded.angular_velocity, imu.angular_velocity);
    EXPECT_EQ(decoded.linear_acceleration, imu.linear_acceleration);
  }
}

TEST(Ros2MessagesTest, Echoes) {
  LaserScan scan = test::SampleScan(1000000000, 3);
  scan.echoes = {{1.f, 2.f}, {}, {3.f}};
  RosHeader header;
  LaserScan decoded;
  ASSERT_TRUE(DecodeMultiEchoLaserScan(
      RosEncoding::kCdr, EncodeLaserScan(scan, "laser"), &header, &decoded));
  EXPECT_EQ(decoded.echoes, scan.echoes);
  EXPECT_EQ(header.time, FirstBeamTime(scan));
  // Of another encoding, cut off, too long.
  const std::string bytes =
      EncodeLaserScan(test::SampleScan(1000000000, 3), "laser");
  EXPECT_TRUE(DecodeLaserScan(RosEncoding::kCdr, bytes, &header, &decoded));
  EXPECT_FALSE(DecodeLaserScan(RosEncoding::kRos1, bytes, &header, &decoded));
  EXPECT_FALSE(DecodeLaserScan(RosEncoding::kCdr, "", &header, &decoded));
  EXPECT_FALSE(DecodeLaserScan(
      RosEncoding::kCdr, bytes.substr(0, bytes.size() - 1), &header, &decoded));
  EXPECT_FALSE(DecodeLaserScan(RosEncoding::kCdr, bytes + std::string(8, '\0'),
                               &header, &decoded));
  std::string big_endian = bytes;
  big_endian[1] = 0;
  EXPECT_FALSE(
      DecodeLaserScan(RosEncoding::kCdr, big_endian, &header, &decoded));
}

TEST(Ros2MessagesTest, DefinitionsNameEveryNestedTypeOnce) {
  const std::string definition = DefinitionOfRos2(kRos2Odometry);
  EXPECT_THAT(definition, StartsWith("std_msgs/Header header\n"));
  EXPECT_THAT(definition,
              HasSubstr(std::string(80, '=') +
                        "\nMSG: geometry_msgs/PoseWithCovariance\n"));
  EXPECT_EQ(definition.find("MSG: geometry_msgs/Vector3"),
            definition.rfind("MSG: geometry_msgs/Vector3"));
  EXPECT_THAT(definition, EndsWith("\n"));
  EXPECT_EQ(DefinitionOfRos2("std_msgs/msg/Unknown"), "");
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
