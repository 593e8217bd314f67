// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0

#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS_EVENT_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS_EVENT_H_

#include <string>

#include "Eigen/Geometry"
#include "cartographer_ext/io/ros/no_return_code.h"
#include "cartographer_ext/io/ros/ros1/rosbag_topics.h"
#include "cartographer_ext/io/ros/ros_container.h"
#include "cartographer_ext/io/ros/ros_messages.h"
#include "cartographer_ext/io/ros/scan_timing.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

enum RosRank { kOdometryRank, kImuRank, kScanRank, kNumRanks };

// A message of one of the chosen topics, not yet in the robot's frame.
struct RosEvent {
  RosRank rank = kOdometryRank;
  SensorEvent event;
  std::string frame;           // of the sensor, or the child of odometry
  Eigen::Isometry3d odometry;  // (odometry <- frame)
  RosPointCloud cloud;         // of a scan, in the frame
};

// Turns messages of the chosen topics into events.
class RosEventDecoder {
 public:
  // All must outlive the decoder; scans of sensors whose `timing` is
  // implausible are treated as instantaneous, readings of a code and beyond as
  // no return.
  RosEventDecoder(RosEncoding encoding, const ChosenTopics* topics,
                  const ScanTiming* timing, const NoReturnCodes* codes)
      : encoding_(encoding),
        topics_(*topics),
        timing_(*timing),
        codes_(*codes) {}

  // False for damaged messages, and for transforms without odometry.
  bool Decode(const RosMessage& message, RosEvent* decoded) const;

 private:
  bool DecodeScan(const RosMessage& message, RosHeader* header,
                  RosEvent* decoded) const;
  // The odometry among the transforms of a message; false where there is none.
  bool FindOdometry(const RosMessage& message, RosEvent* decoded) const;

  const RosEncoding encoding_;
  const ChosenTopics& topics_;
  const ScanTiming& timing_;
  const NoReturnCodes& codes_;
};

// Adds the beam times and the readings of a decoded scan.
void AddScan(const std::string& topic, const RosEvent& decoded,
             ScanTiming* timing, NoReturnCodes* codes);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS_EVENT_H_
