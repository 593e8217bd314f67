// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_topics.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/io/ros/ros_messages.h"

namespace cartographer_ext {
namespace io {
namespace {

// The topic asked for, if its type is one of `types`; or the first by name of
// the first type that occurs; or none.
absl::StatusOr<std::string> Choose(const RosTopics& topics,
                                   const std::vector<RosType>& types,
                                   const std::string& asked_for,
                                   const std::string& what,
                                   std::vector<std::string>* warnings) {
  if (!asked_for.empty()) {
    auto it = topics.find(asked_for);
    if (it == topics.end()) it = topics.find(absl::StrCat("/", asked_for));
    if (it == topics.end()) {
      return absl::NotFoundError(
          absl::StrCat("no topic \"", asked_for, "\" for ", what,
                       "; topics: ", ListTopics(topics)));
    }
    for (const RosType& type : types) {
      if (it->second.md5sum == type.md5sum) return it->first;
    }
    return absl::InvalidArgumentError(absl::StrCat(
        "topic ", it->first, " has type ", it->second.name,
        ", which is none for ", what, "; topics: ", ListTopics(topics)));
  }
  for (const RosType& type : types) {
    std::vector<std::string> found;
    for (const auto& topic : topics) {
      if (topic.second.md5sum == type.md5sum) found.push_back(topic.first);
    }
    if (found.size() > 1) {
      warnings->push_back(absl::StrCat("several topics for ", what, " (",
                                       absl::StrJoin(found, ", "), "); taking ",
                                       found.front()));
    }
    if (!found.empty()) return found.front();
  }
  return std::string();
}

}  // namespace

std::string ListTopics(const RosTopics& topics) {
  if (topics.empty()) return "none";
  return absl::StrJoin(
      topics, ", ", [](std::string* out, const RosTopics::value_type& it) {
        absl::StrAppend(out, it.first, " (", it.second.name, ")");
      });
}

absl::StatusOr<ChosenTopics> ChooseTopics(const RosTopics& topics,
                                          const SensorSourceOptions& options) {
  ChosenTopics chosen;
  auto scan = Choose(topics, {kRosLaserScan, kRosMultiEchoLaserScan},
                     options.scan_topic, "laser scans", &chosen.warnings);
  if (!scan.ok()) return scan.status();
  if (scan->empty()) {
    return absl::NotFoundError(absl::StrCat(
        "no topic of type sensor_msgs/LaserScan or MultiEchoLaserScan; "
        "topics: ",
        ListTopics(topics)));
  }
  chosen.scan = *scan;
  chosen.multi_echo =
      topics.at(chosen.scan).md5sum == kRosMultiEchoLaserScan.md5sum;
  auto odometry = Choose(topics, {kRosOdometry}, options.odometry_topic,
                         "odometry", &chosen.warnings);
  if (!odometry.ok()) return odometry.status();
  chosen.odometry = *odometry;
  auto imu =
      Choose(topics, {kRosImu}, options.imu_topic, "an IMU", &chosen.warnings);
  if (!imu.ok()) return imu.status();
  chosen.imu = *imu;
  for (const auto& topic : topics) {
    if (topic.second.md5sum == kRosTransforms.md5sum) {
      chosen.transforms.insert(topic.first);
    }
  }
  return chosen;
}

}  // namespace io
}  // namespace cartographer_ext
