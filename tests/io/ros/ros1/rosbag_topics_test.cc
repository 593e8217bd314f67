// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_topics.h"

#include <string>

#include "cartographer_ext/io/ros/ros_messages.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

RosTopicType Type(const RosType& type) {
  return RosTopicType{type.name, type.md5sum};
}

TEST(RosbagTopicsTest, Defaults) {
  RosTopics topics;
  topics["/a_echoes"] = Type(kRosMultiEchoLaserScan);
  topics["/scan_rear"] = Type(kRosLaserScan);
  topics["/scan_front"] = Type(kRosLaserScan);
  topics["/odom"] = Type(kRosOdometry);
  topics["/tf"] = Type(kRosTransforms);
  topics["/tf_static"] = Type(kRosTransforms);
  topics["/image"] = RosTopicType{"sensor_msgs/Image", "123"};
  const auto chosen = ChooseTopics(topics, {});
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  // Plain scans before echoes, then by name.
  EXPECT_THAT(chosen->scans,
              ElementsAre(Pair("/scan_front", RosScanType::kLaserScan)));
  EXPECT_EQ(chosen->odometry, "/odom");
  EXPECT_EQ(chosen->imu, "");
  EXPECT_THAT(chosen->transforms, ElementsAre("/tf", "/tf_static"));
  ASSERT_EQ(chosen->warnings.size(), 1u);
  EXPECT_THAT(chosen->warnings[0],
              HasSubstr("(/scan_front, /scan_rear); taking /scan_front"));
}

TEST(RosbagTopicsTest, AskedFor) {
  RosTopics topics;
  topics["/echoes"] = Type(kRosMultiEchoLaserScan);
  topics["/scan"] = Type(kRosLaserScan);
  topics["/imu"] = Type(kRosImu);
  SensorSourceOptions options;
  options.scan_topic = "echoes";
  options.imu_topic = "/imu";
  const auto chosen = ChooseTopics(topics, options);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_THAT(chosen->scans,
              ElementsAre(Pair("/echoes", RosScanType::kMultiEchoLaserScan)));
  EXPECT_FALSE(chosen->odometry_from_transforms);
  EXPECT_EQ(chosen->imu, "/imu");
  EXPECT_TRUE(chosen->warnings.empty());
  options.odometry_topic = "/scan";
  EXPECT_THAT(std::string(ChooseTopics(topics, options).status().message()),
              HasSubstr("type sensor_msgs/LaserScan, which is none for"));
  options.odometry_topic = "/wheels";
  EXPECT_THAT(std::string(ChooseTopics(topics, options).status().message()),
              HasSubstr("no topic \"/wheels\" for odometry; topics: /echoes"));
}

TEST(RosbagTopicsTest, SeveralLasersWithAndWithoutSlash) {
  RosTopics topics;
  topics["front"] = Type(kRosLaserScan);
  topics["/rear"] = Type(kRosPointCloud2);
  topics["/tf"] = Type(kRosTransforms);
  SensorSourceOptions options;
  options.scan_topic = "/front,rear";
  auto chosen = ChooseTopics(topics, options);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_THAT(chosen->scans,
              ElementsAre(Pair("/rear", RosScanType::kPointCloud2),
                          Pair("front", RosScanType::kLaserScan)));
  EXPECT_TRUE(chosen->warnings.empty());
  EXPECT_TRUE(chosen->odometry_from_transforms);
  options.scan_topic = "front,side";
  EXPECT_THAT(std::string(ChooseTopics(topics, options).status().message()),
              HasSubstr("no topic \"side\""));
  // Points only where there is no scan.
  chosen = ChooseTopics(topics, {});
  EXPECT_THAT(chosen->scans,
              ElementsAre(Pair("front", RosScanType::kLaserScan)));
  topics.erase("front");
  chosen = ChooseTopics(topics, {});
  EXPECT_THAT(chosen->scans,
              ElementsAre(Pair("/rear", RosScanType::kPointCloud2)));
}

TEST(RosbagTopicsTest, OdometryOfTransformsOnDemandOrWithoutMessages) {
  RosTopics topics;
  topics["/scan"] = Type(kRosLaserScan);
  topics["/odom"] = Type(kRosOdometry);
  topics["/tf"] = Type(kRosTransforms);
  EXPECT_EQ(ChooseTopics(topics, {})->odometry, "/odom");
  EXPECT_FALSE(ChooseTopics(topics, {})->odometry_from_transforms);
  SensorSourceOptions options;
  options.odometry_topic = "tf";
  const auto chosen = ChooseTopics(topics, options);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_EQ(chosen->odometry, "");
  EXPECT_TRUE(chosen->odometry_from_transforms);
}

TEST(RosbagTopicsTest, NoScans) {
  EXPECT_THAT(std::string(ChooseTopics({}, {}).status().message()),
              HasSubstr("topics: none"));
  // The same name with another definition is another type.
  RosTopics topics;
  topics["/scan"] = RosTopicType{"sensor_msgs/LaserScan", "other"};
  EXPECT_THAT(std::string(ChooseTopics(topics, {}).status().message()),
              HasSubstr("topics: /scan (sensor_msgs/LaserScan)"));
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
