// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A file or folder of recorded ROS messages, in any format: ROS 1 bag, MCAP,
// rosbag2 database. Independent of the content of the messages, which
// OpenRosRecording decodes.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS_CONTAINER_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS_CONTAINER_H_

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/ros/ros1/rosbag_topics.h"
#include "cartographer_ext/io/ros/ros_messages.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// A container may hold any number for the time of recording: those farther from
// 1970 (126 years) become this one or its negative, so that times can be added
// and subtracted.
constexpr TimeNs kMaxRecorded = 4000000000000000000;

struct RosMessage {
  std::string topic;
  TimeNs received = 0;  // when it was recorded; at most kMaxRecorded from 0
  std::string data;     // serialized
};

class RosContainer {
 public:
  virtual ~RosContainer() = default;

  virtual std::string format() const = 0;  // "rosbag", "mcap", "db3"
  virtual RosEncoding encoding() const = 0;
  virtual const RosTopics& topics() const = 0;

  // Starts over; Next gives the messages on `topics` only, in the order of the
  // recording. Without a call there are no messages.
  virtual absl::Status Rewind(const std::set<std::string>& topics) = 0;
  // False at the end. Errors name the file.
  virtual absl::StatusOr<bool> Next(RosMessage* message) = 0;

  // Tolerated problems of the file. Complete after reading all of it. They name
  // the file.
  virtual std::vector<std::string> warnings() const { return {}; }
};

// Opens the recording in a container. Errors and warnings name `filename`.
absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosRecording(
    const std::string& filename, std::unique_ptr<RosContainer> container,
    const SensorSourceOptions& options);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS_CONTAINER_H_
