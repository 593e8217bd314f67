// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Interface of a recording, independent of its file format: a stream of scans,
// odometry and IMU readings in order of their stamps. A new format is a new
// SensorSource.
#ifndef CARTOGRAPHER_EXT_IO_SENSOR_SOURCE_H_
#define CARTOGRAPHER_EXT_IO_SENSOR_SOURCE_H_

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "absl/types/variant.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace io {

// Nanoseconds since the Unix epoch (or since the start of a log whose stamps
// are relative).
using TimeNs = int64_t;

inline double ToSeconds(TimeNs time) {
  return 1e-9 * static_cast<double>(time);
}
inline TimeNs FromSeconds(double seconds) {
  return static_cast<TimeNs>(std::llround(seconds * 1e9));
}

// One revolution or sweep of a planar laser. Beam i points to
// angle_min + i * angle_increment in the laser frame (x forward, y left).
struct LaserScan {
  TimeNs time = 0;              // of the last beam unless time_increment is 0
  double time_increment = 0.;   // seconds between beams
  double angle_min = 0.;        // radians
  double angle_increment = 0.;  // radians
  double range_min = 0.;        // metres
  double range_max = 0.;        // metres; a range above it is "no return"
  std::vector<float> ranges;    // metres; NaN, inf and "no return" kept as read
  Pose2 laser_pose;             // (robot <- laser)
  // Instead of ranges, from lasers that deliver points: in the laser frame.
  std::vector<Eigen::Vector2d> points;
  // Of each point, seconds before `time` (not above 0); empty: all at once.
  std::vector<float> point_times;
  // Every echo of beam i, for multi-echo lasers; `ranges` has the first.
  std::vector<std::vector<float>> echoes;
  // CARMEN logs carry the robot's odometry pose (odometry <- robot) inside the
  // scan line; the reader also emits it as an OdometryReading before the scan.
  std::string sensor_id = "laser";
};

struct OdometryReading {
  TimeNs time = 0;
  Pose2 pose;                // (odometry <- robot)
  bool inside_scan = false;  // taken from a scan line, not a message of its own
};

struct ImuReading {
  TimeNs time = 0;
  Eigen::Vector3d linear_acceleration = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();     // rad/s
};

using SensorEvent = absl::variant<LaserScan, OdometryReading, ImuReading>;

inline TimeNs EventTime(const SensorEvent& event) {
  return absl::visit([](const auto& e) { return e.time; }, event);
}

// Contents of a recording, known after opening it.
struct SensorSourceInfo {
  std::string format;  // "carmen", "rosbag", "mcap", "db3", "world"
  int64_t num_scans = 0;
  int64_t num_odometry = 0;
  int64_t num_imu = 0;
  TimeNs begin = 0;
  TimeNs end = 0;
  // The lasers, as LaserScan::sensor_id names them, where there are several.
  std::vector<std::string> lasers;
  int64_t num_out_of_order = 0;       // stamps that went backwards, sorted
  std::vector<std::string> warnings;  // lines skipped, topics guessed, ...
};

class SensorSource {
 public:
  virtual ~SensorSource() = default;
  virtual const SensorSourceInfo& info() const = 0;
  // False at the end. Events come in non-decreasing order of time; of equal
  // stamps odometry and IMU come before scans. An error names file and line.
  virtual absl::StatusOr<bool> Next(SensorEvent* event) = 0;
};

struct SensorSourceOptions {
  // Of ROS; empty: the only (or first by name) topic of that type. Scans of
  // several topics, separated by commas, are read together. For the odometry, a
  // topic of transforms may be given as well.
  std::string scan_topic;
  std::string odometry_topic;
  std::string imu_topic;
  std::string tracking_frame = "base_link";
  // CARMEN only: emit the odometry inside FLASER/ROBOTLASER1 lines ("scan"),
  // the ODOM lines ("odom"), both ("both"), or what suits the log ("auto"):
  // ODOM lines where they cover the run and stamps are in order, else those
  // inside the scan lines (see carmen_reader.h).
  std::string odometry_source = "auto";
};

// Opens a log by its content and name: .clf/.log (also .gz .xz .bz2), .bag,
// .mcap, .db3, or a folder of rosbag2.
// Worlds are opened by simulation::OpenWorld.
absl::StatusOr<std::unique_ptr<SensorSource>> OpenSensorSource(
    const std::string& filename, const SensorSourceOptions& options);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_SENSOR_SOURCE_H_
