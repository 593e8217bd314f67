// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes ROS 1 bags: sensor_msgs/LaserScan (MultiEchoLaserScan for scans with
// echoes), nav_msgs/Odometry with the same pose in /tf, sensor_msgs/Imu, and
// the sensors' poses in /tf_static. Needs librosbag-storage at build time;
// without it Open fails and says so.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_WRITER_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_WRITER_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

struct RosbagWriterOptions {
  std::string scan_topic = "/scan";
  std::string odometry_topic = "/odom";
  std::string imu_topic = "/imu";
  std::string odometry_frame = "odom";
  std::string tracking_frame = "base_link";
  std::string laser_frame = "laser";
  std::string imu_frame = "imu_link";  // at the tracking frame
  std::string compression = "bz2";     // none, bz2, lz4
};

class RosbagWriter {
 public:
  virtual ~RosbagWriter() = default;

  static absl::StatusOr<std::unique_ptr<RosbagWriter>> Open(
      const std::string& filename, const RosbagWriterOptions& options);

  // Messages in order of time. Stamps must be positive and below 2^32 seconds.
  // The pose of the laser is taken from the first scan.
  virtual absl::Status AddScan(const LaserScan& scan) = 0;
  virtual absl::Status AddOdometry(const OdometryReading& reading,
                                   double linear_velocity = 0.,
                                   double angular_velocity = 0.) = 0;
  virtual absl::Status AddImu(const ImuReading& reading) = 0;

  // Puts the file in place; without it nothing is left behind.
  virtual absl::Status Finish() = 0;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_WRITER_H_
