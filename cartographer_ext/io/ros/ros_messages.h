// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Decoding of the serialized ROS 1 and ROS 2 messages we read. We use our own
// decoder because generated code trusts array lengths and would allocate
// gigabytes for a damaged file; here every length is checked against the
// remaining size of the message.
//
// ROS 1: fields one after another, little endian; strings and arrays with a
// uint32 length in front; a stamp is two uint32, seconds and nanoseconds.
// ROS 2 (CDR, little endian): four bytes of encapsulation (0 1 and two of
// options), then the fields, each aligned to its size counted from there; the
// length of a string counts its final zero; a header has no sequence number.
// The fields of the messages we read are the same and in the same order.
#ifndef CARTOGRAPHER_EXT_IO_ROS_ROS_MESSAGES_H_
#define CARTOGRAPHER_EXT_IO_ROS_ROS_MESSAGES_H_

#include <string>
#include <vector>

#include "Eigen/Geometry"
#include "absl/strings/string_view.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// Names of the types in bags, and the checksums of their definitions.
struct RosType {
  const char* name;
  const char* md5sum;
};
constexpr RosType kRosLaserScan{"sensor_msgs/LaserScan",
                                "90c7ef2dc6895d81024acba2ac42f369"};
constexpr RosType kRosMultiEchoLaserScan{"sensor_msgs/MultiEchoLaserScan",
                                         "6fefb0c6da89d7c8abe4b339f5c2f8fb"};
constexpr RosType kRosPointCloud2{"sensor_msgs/PointCloud2",
                                  "1158d486dd51d683ce2f1be655c3c181"};
constexpr RosType kRosOdometry{"nav_msgs/Odometry",
                               "cd5e73d190d741a2f92e81eda573aca7"};
constexpr RosType kRosImu{"sensor_msgs/Imu",
                          "6a62c6daae103f4ff57a132d6f95cec2"};
// Also the checksum of tf/tfMessage.
constexpr RosType kRosTransforms{"tf2_msgs/TFMessage",
                                 "94810edda583a504dfda3829e70d7eec"};

enum class RosEncoding { kRos1, kCdr };

struct RosHeader {
  TimeNs time = 0;
  std::string frame;  // without a leading slash
};

struct RosTransform {
  RosHeader header;         // header.frame is the parent
  std::string child_frame;  // without a leading slash
  Eigen::Isometry3d pose;   // (parent <- child)
};

struct RosPointCloud {
  std::vector<Eigen::Vector3d> points;
  // Of each point, seconds after the stamp of the message. Empty where it has
  // none, or where they are not within a second of the stamp.
  std::vector<double> times;
};

// From the first beam or point of a scan to the last.
double SweepSeconds(const LaserScan& scan);

// All return false for messages that are too short, too long, or have invalid
// values (poses that are not finite, no beams or more than
// CarmenLine::kMaxReadings, beams over more than a full turn).

// `scan->time` becomes the time of the last beam.
bool DecodeLaserScan(RosEncoding encoding, absl::string_view data,
                     RosHeader* header, LaserScan* scan);
bool DecodeMultiEchoLaserScan(RosEncoding encoding, absl::string_view data,
                              RosHeader* header, LaserScan* scan);
// The points with finite coordinates, in the frame of the sensor; the fields x,
// y and z have to be float32 and little endian. Times are taken from a field
// "t", "time", "timestamp", "time_stamp", "time_offset" or "offset_time":
// nanoseconds if it is an integer, seconds if it is a float, after the stamp of
// the message or, if a double, absolute (seconds or nanoseconds).
bool DecodePointCloud2(RosEncoding encoding, absl::string_view data,
                       RosHeader* header, RosPointCloud* cloud);
// `pose` is (header.frame <- child_frame).
bool DecodeOdometry(RosEncoding encoding, absl::string_view data,
                    RosHeader* header, std::string* child_frame,
                    Eigen::Isometry3d* pose);
// In the frame of the sensor.
bool DecodeImu(RosEncoding encoding, absl::string_view data, RosHeader* header,
               ImuReading* reading);
bool DecodeTransforms(RosEncoding encoding, absl::string_view data,
                      std::vector<RosTransform>* transforms);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ROS_ROS_MESSAGES_H_
