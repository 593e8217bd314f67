// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/ros2_messages.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/io/ros/ros_messages.h"

namespace cartographer_ext {
namespace io {
namespace {

class CdrEncoder {
 public:
  CdrEncoder() : bytes_{"\0\1\0\0", 4} {}  // little endian

  template <typename T>
  void Put(const T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back('\0');
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void PutString(const std::string& text) {
    Put(static_cast<uint32_t>(text.size() + 1));
    bytes_.append(text.c_str(), text.size() + 1);
  }
  void PutFloats(const std::vector<float>& values) {
    Put(static_cast<uint32_t>(values.size()));
    for (const float value : values) Put(value);
  }
  void PutDoubles(const int count, const double value) {
    for (int i = 0; i < count; ++i) Put(value);
  }
  void PutHeader(const TimeNs time, const std::string& frame) {
    Put(static_cast<int32_t>(time / 1000000000));
    Put(static_cast<uint32_t>(time % 1000000000));
    PutString(frame);
  }
  void PutVector(const Eigen::Vector3d& vector) {
    for (int i = 0; i < 3; ++i) Put(vector[i]);
  }
  // Translation and quaternion.
  void PutPose(const Pose2& pose) {
    PutVector(Eigen::Vector3d(pose.x, pose.y, 0.));
    PutVector(Eigen::Vector3d(0., 0., std::sin(0.5 * pose.theta)));
    Put(std::cos(0.5 * pose.theta));
  }
  std::string Finish() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Fields by type. Nested types are named with their package.
struct Definition {
  const char* type;
  const char* fields;
};
constexpr Definition kDefinitions[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion",
     "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose",
     "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance",
     "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist",
     "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance",
     "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform "
     "transform\n"},
    {"sensor_msgs/LaserEcho", "float32[] echoes\n"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 "
     "angle_increment\nfloat32 time_increment\n"
     "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] "
     "ranges\nfloat32[] intensities\n"},
    {"sensor_msgs/MultiEchoLaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 "
     "angle_increment\nfloat32 time_increment\n"
     "float32 scan_time\nfloat32 range_min\nfloat32 "
     "range_max\nsensor_msgs/LaserEcho[] ranges\n"
     "sensor_msgs/LaserEcho[] intensities\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] "
     "orientation_covariance\n"
     "geometry_msgs/Vector3 angular_velocity\nfloat64[9] "
     "angular_velocity_covariance\n"
     "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] "
     "linear_acceleration_covariance\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring "
     "child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
};

const char* FieldsOf(const std::string& type) {
  for (const Definition& definition : kDefinitions) {
    if (type == definition.type) return definition.fields;
  }
  return nullptr;
}

// Appends the definitions of the types in `fields` that are not `seen` yet.
void AppendNested(const std::string& fields, std::set<std::string>* seen,
                  std::string* text) {
  for (const absl::string_view line :
       absl::StrSplit(fields, '\n', absl::SkipEmpty())) {
    const std::string type(line.substr(0, line.find_first_of(" [")));
    const char* nested = FieldsOf(type);
    if (nested == nullptr || !seen->insert(type).second) continue;
    absl::StrAppend(text, std::string(80, '='), "\nMSG: ", type, "\n", nested);
    AppendNested(nested, seen, text);
  }
}

}  // namespace

TimeNs FirstBeamTime(const LaserScan& scan) {
  return scan.time - FromSeconds(SweepSeconds(scan));
}

std::string EncodeLaserScan(const LaserScan& scan, const std::string& frame) {
  CdrEncoder encoder;
  encoder.PutHeader(FirstBeamTime(scan), frame);
  encoder.Put(static_cast<float>(scan.angle_min));
  encoder.Put(static_cast<float>(
      scan.angle_min +
      scan.angle_increment * (static_cast<double>(scan.ranges.size()) - 1.)));
  encoder.Put(static_cast<float>(scan.angle_increment));
  encoder.Put(static_cast<float>(scan.time_increment));
  encoder.Put(0.f);  // time between scans: not known
  encoder.Put(static_cast<float>(scan.range_min));
  encoder.Put(static_cast<float>(scan.range_max));
  if (scan.echoes.empty()) {
    encoder.PutFloats(scan.ranges);
  } else {
    encoder.Put(static_cast<uint32_t>(scan.echoes.size()));
    for (const std::vector<float>& echoes : scan.echoes)
      encoder.PutFloats(echoes);
  }
  encoder.Put(uint32_t{0});  // no intensities
  return encoder.Finish();
}

std::string EncodeOdometry(const OdometryReading& reading,
                           const double linear_velocity,
                           const double angular_velocity,
                           const std::string& frame,
                           const std::string& child_frame) {
  CdrEncoder encoder;
  encoder.PutHeader(reading.time, frame);
  encoder.PutString(child_frame);
  encoder.PutPose(reading.pose);
  encoder.PutDoubles(36, 0.);
  encoder.PutVector(Eigen::Vector3d(linear_velocity, 0., 0.));
  encoder.PutVector(Eigen::Vector3d(0., 0., angular_velocity));
  encoder.PutDoubles(36, 0.);
  return encoder.Finish();
}

std::string EncodeImu(const ImuReading& reading, const std::string& frame) {
  CdrEncoder encoder;
  encoder.PutHeader(reading.time, frame);
  encoder.PutDoubles(3, 0.);
  encoder.Put(1.);
  encoder.Put(
      -1.);  // the first of the covariance: no estimate of the orientation
  encoder.PutDoubles(8, 0.);
  encoder.PutVector(reading.angular_velocity);
  encoder.PutDoubles(9, 0.);
  encoder.PutVector(reading.linear_acceleration);
  encoder.PutDoubles(9, 0.);
  return encoder.Finish();
}

std::string EncodeTransform(const TimeNs time, const std::string& parent,
                            const std::string& child, const Pose2& pose) {
  CdrEncoder encoder;
  encoder.Put(uint32_t{1});
  encoder.PutHeader(time, parent);
  encoder.PutString(child);
  encoder.PutPose(pose);
  return encoder.Finish();
}

std::string DefinitionOfRos2(const std::string& type) {
  const size_t at = type.find("/msg/");
  if (at == std::string::npos) return "";
  const char* fields =
      FieldsOf(absl::StrCat(type.substr(0, at), "/", type.substr(at + 5)));
  if (fields == nullptr) return "";
  std::string text = fields;
  std::set<std::string> seen;
  AppendNested(fields, &seen, &text);
  return text;
}

}  // namespace io
}  // namespace cartographer_ext
