// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// ROS 1 bags (format 2.0; chunks plain, bz2 or lz4) as a SensorSource. They are
// read from the beginning to the end; the index is not used, so bags without
// one (from a killed recorder) or with a wrong one are read as well, with a
// warning. A damaged chunk is left out, with a warning; where the damage hides
// the next record, the index says where the next chunk begins. The rest holds
// for ROS 2 recordings as well.
//
// Topics. Scans: sensor_msgs/LaserScan, MultiEchoLaserScan, or PointCloud2 of a
// laser that measures in one plane; nav_msgs/Odometry and sensor_msgs/Imu. They
// are named by the options, with or without the first slash; otherwise the only
// one of the type or the first by name is used, with a warning (LaserScan
// before MultiEchoLaserScan before PointCloud2). Several scan topics, separated
// by commas, are read together. Without odometry messages the transforms
// between "odom" (REP 105) and its child are the odometry, if they change. A
// scan topic is needed, the others are not. Errors about topics list all topics
// of the recording with their types.
//
// Frames. Sensor poses come from the transforms on topics of type
// tf2_msgs/TFMessage (/tf_static, /tf), as far as they do not move; a frame
// that no chain joins to the tracking frame is taken to coincide with it, with
// a warning. Where the tracking frame does not occur in the bag, the frame of
// the odometry takes its place. Lasers mounted upside down deliver their beams
// mirrored. IMU readings are rotated into the tracking frame.
//
// Stamps are those of the headers (of the last beam for scans, whose header has
// the first); where they are zero, the time of recording.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_READER_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Bags of which nothing can be read and bags without scans are errors. Single
// messages that cannot be decoded are skipped and counted in a warning.
absl::StatusOr<std::unique_ptr<SensorSource>> OpenRosbag(
    const std::string& filename, const SensorSourceOptions& options);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS1_ROSBAG_READER_H_
