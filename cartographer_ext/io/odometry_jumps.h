// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Odometry without what no robot drives: a damaged line of a log that puts it
// 600 m away for one reading makes Cartographer's grids grow beyond memory.
// Smaller faults are left to local SLAM (front_end/odometry).
#ifndef CARTOGRAPHER_EXT_IO_ODOMETRY_JUMPS_H_
#define CARTOGRAPHER_EXT_IO_ODOMETRY_JUMPS_H_

#include <cstdint>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

class OdometryJumps {
 public:
  // Farther than this, faster than this: between two readings.
  static constexpr double kMaxDistance = 10.;  // metres
  static constexpr double kMaxSpeed = 50.;     // metres per second

  // (odometry <- robot) without the jumps so far, of readings in order of time:
  // in a jump the robot stands. The same pose where there was none.
  Pose2 Remove(TimeNs time, const Pose2& pose);

  int64_t count() const { return count_; }
  // Of the first jump: when, and how far in metres.
  TimeNs first_time() const { return first_time_; }
  double first_distance() const { return first_distance_; }

 private:
  bool has_last_ = false;
  TimeNs last_time_ = 0;
  Pose2 last_raw_;
  Pose2 correction_;  // (odometry without jumps <- odometry)
  int64_t count_ = 0;
  TimeNs first_time_ = 0;
  double first_distance_ = 0.;
};

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_ODOMETRY_JUMPS_H_
