// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the topics of a bag to read.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_TOPICS_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_TOPICS_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

struct RosTopicType {
  std::string name;
  std::string md5sum;
};

// The types of a bag's topics.
using RosTopics = std::map<std::string, RosTopicType>;

enum class RosScanType { kLaserScan, kMultiEchoLaserScan, kPointCloud2 };

struct ChosenTopics {
  std::map<std::string, RosScanType> scans;  // by topic
  std::string odometry;                      // empty: none
  // Without such messages, odometry may come from the transforms.
  bool odometry_from_transforms = false;
  std::string imu;  // empty: none
  std::set<std::string> transforms;
  std::vector<std::string> warnings;
};

// The type of a topic as used by ChooseTopics: "sensor_msgs/msg/LaserScan" has
// the fields of the ROS 1 type "sensor_msgs/LaserScan" and gets its checksum.
RosTopicType TypeOfRos2(const std::string& name);

// "/odom (nav_msgs/Odometry), /scan (sensor_msgs/LaserScan)".
std::string ListTopics(const RosTopics& topics);

// Errors do not name the file.
absl::StatusOr<ChosenTopics> ChooseTopics(const RosTopics& topics,
                                          const SensorSourceOptions& options);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_TOPICS_H_
