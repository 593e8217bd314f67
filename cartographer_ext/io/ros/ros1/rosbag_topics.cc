// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros1/rosbag_topics.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "cartographer_ext/io/ros/ros_messages.h"

namespace cartographer_ext {
namespace io {
namespace {

// The requested topic, if its type is one of `types`; without a request the
// first by name of the first type that occurs; or none.
absl::StatusOr<std::string> Choose(const RosTopics& topics,
                                   const std::vector<RosType>& types,
                                   const std::string& asked_for,
                                   const std::string& what,
                                   const std::string& hint,
                                   std::vector<std::string>* warnings) {
  if (!asked_for.empty()) {
    auto it = topics.find(asked_for);
    if (it == topics.end()) {
      it = topics.find(asked_for[0] == '/' ? asked_for.substr(1)
                                           : absl::StrCat("/", asked_for));
    }
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
                                       found.front(), hint));
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

namespace {

absl::Status ChooseScans(const RosTopics& topics, const std::string& asked_for,
                         ChosenTopics* chosen) {
  for (const absl::string_view name : absl::StrSplit(asked_for, ',')) {
    const auto scan =
        Choose(topics, {kRosLaserScan, kRosMultiEchoLaserScan, kRosPointCloud2},
               std::string(name), "laser scans",
               "; -scan_topic names others, or several", &chosen->warnings);
    if (!scan.ok()) return scan.status();
    if (scan->empty()) {
      return absl::NotFoundError(absl::StrCat(
          "no topic of type sensor_msgs/LaserScan, MultiEchoLaserScan or "
          "PointCloud2; topics: ",
          ListTopics(topics)));
    }
    const std::string& md5sum = topics.at(*scan).md5sum;
    chosen->scans[*scan] =
        md5sum == kRosLaserScan.md5sum     ? RosScanType::kLaserScan
        : md5sum == kRosPointCloud2.md5sum ? RosScanType::kPointCloud2
                                           : RosScanType::kMultiEchoLaserScan;
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ChosenTopics> ChooseTopics(const RosTopics& topics,
                                          const SensorSourceOptions& options) {
  ChosenTopics chosen;
  const absl::Status scans = ChooseScans(topics, options.scan_topic, &chosen);
  if (!scans.ok()) return scans;
  std::vector<RosType> odometry_types = {kRosOdometry};
  if (!options.odometry_topic.empty()) {
    odometry_types.push_back(kRosTransforms);
  }
  auto odometry =
      Choose(topics, odometry_types, options.odometry_topic, "odometry",
             "; -odometry_topic names another", &chosen.warnings);
  if (!odometry.ok()) return odometry.status();
  chosen.odometry = *odometry;
  auto imu = Choose(topics, {kRosImu}, options.imu_topic, "an IMU",
                    "; -imu_topic names another", &chosen.warnings);
  if (!imu.ok()) return imu.status();
  chosen.imu = *imu;
  for (const auto& topic : topics) {
    if (topic.second.md5sum == kRosTransforms.md5sum) {
      chosen.transforms.insert(topic.first);
    }
  }
  if (chosen.transforms.count(chosen.odometry) > 0) chosen.odometry.clear();
  chosen.odometry_from_transforms =
      chosen.odometry.empty() && !chosen.transforms.empty();
  return chosen;
}

RosTopicType TypeOfRos2(const std::string& name) {
  RosTopicType type;
  type.name = name;
  const size_t at = name.find("/msg/");
  if (at == std::string::npos) return type;
  const std::string ros1 =
      absl::StrCat(name.substr(0, at), "/", name.substr(at + 5));
  for (const RosType& known :
       {kRosLaserScan, kRosMultiEchoLaserScan, kRosPointCloud2, kRosOdometry,
        kRosImu, kRosTransforms}) {
    if (ros1 == known.name) type.md5sum = known.md5sum;
  }
  return type;
}

}  // namespace io
}  // namespace cartographer_ext
