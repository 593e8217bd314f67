// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The messages that we write, in CDR (see ros_messages.h for the encoding), and
// their definitions for MCAP files.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS2_MESSAGES_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS2_MESSAGES_H_

#include <string>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

constexpr char kRos2LaserScan[] = "sensor_msgs/msg/LaserScan";
constexpr char kRos2MultiEchoLaserScan[] = "sensor_msgs/msg/MultiEchoLaserScan";
constexpr char kRos2Odometry[] = "nav_msgs/msg/Odometry";
constexpr char kRos2Imu[] = "sensor_msgs/msg/Imu";
constexpr char kRos2Transforms[] = "tf2_msgs/msg/TFMessage";

// Of the first beam, which is what the header of a scan has.
TimeNs FirstBeamTime(const LaserScan& scan);

// A MultiEchoLaserScan for a scan with echoes, else a LaserScan.
std::string EncodeLaserScan(const LaserScan& scan, const std::string& frame);
std::string EncodeOdometry(const OdometryReading& reading,
                           double linear_velocity, double angular_velocity,
                           const std::string& frame,
                           const std::string& child_frame);
std::string EncodeImu(const ImuReading& reading, const std::string& frame);
// One transform, (parent <- child).
std::string EncodeTransform(TimeNs time, const std::string& parent,
                            const std::string& child, const Pose2& pose);

// "ros2msg": the definition of the type and of all types in it. Empty for other
// types than those above.
std::string DefinitionOfRos2(const std::string& type);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS2_MESSAGES_H_
