// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One line of a CARMEN log. Every message ends with
// "ipc_timestamp ipc_hostname logger_timestamp"; the first one is the stamp.
//
//   FLASER n r1..rn  x y theta  odom_x odom_y odom_theta
//   ROBOTLASER1 laser_type start_angle field_of_view angular_resolution
//       maximum_range accuracy remission_mode  n r1..rn  m remission1..m
//       laser_x laser_y laser_theta  robot_x robot_y robot_theta
//       laser_tv laser_rv forward_safety_dist side_safety_dist turn_axis
//   RAWLASER1 as ROBOTLASER1 up to the remissions
//   ODOM x y theta tv rv accel
//   PARAM name value
//
// Older layouts lack the last stamp or the host as well, the velocities of
// ODOM, one of the two poses of FLASER, or the remissions of the lasers. They
// are distinguished by the number of words.
//
// In FLASER, x y theta is the pose of the laser and the odom_ fields are the
// pose of the robot, both in the odometry frame (or the first one in a map
// frame, where the log was corrected).
#ifndef CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_LINE_H_
#define CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_LINE_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

enum class CarmenKind {
  kIgnored,     // comments, blank lines, messages of no interest
  kRearLaser,   // RLASER and lasers of other numbers: not read
  kMalformed,   // `error` says why
  kParameter,   // `name`, `value`
  kOdometry,    // `time`, `robot_pose`
  kFrontLaser,  // FLASER
  kRobotLaser,  // ROBOTLASER1
  kRawLaser,    // RAWLASER1, without poses
  kFilterMark,  // NEFF, of a particle filter (particle_filter_log.h)
};

struct CarmenLine {
  // More readings than any laser has in one sweep.
  static constexpr int kMaxReadings = 16384;

  CarmenKind kind = CarmenKind::kIgnored;
  const char* error = "";
  TimeNs time = 0;
  size_t num_stamp_words = 0;  // the stamp, the host, the stamp of the logger
  std::string name;
  std::string value;

  std::vector<float> ranges;  // metres
  double angle_min = 0.;
  double angle_increment = 0.;
  double maximum_range = 0.;  // 0: not in the line
  Pose2 laser_pose;           // (odometry <- laser)
  Pose2 robot_pose;           // (odometry <- robot)
};

// Beam angles of a FLASER line, which does not contain them: beam 0 points to
// -90 degrees. n = 180, 360, ...: steps of 180/n; 181, 361, ...: steps of
// 180/(n-1); n = 101, 201, 401: the 100 degree mode of SICK lasers, from -50
// degrees.
void FrontLaserAngles(int n, double* angle_min, double* angle_increment);

// Overwrites `line`, reusing its memory.
void ParseCarmenLine(absl::string_view text, CarmenLine* line);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_CARMEN_CARMEN_LINE_H_
