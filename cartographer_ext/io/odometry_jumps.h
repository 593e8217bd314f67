// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Removes implausible jumps from odometry: a damaged log line that moves it 600
// m away for one reading makes Cartographer's grids exceed the memory. Smaller
// faults are handled by local SLAM (front_end/odometry).
#ifndef CARTOGRAPHER_EXT_IO_ODOMETRY_JUMPS_H_
#define CARTOGRAPHER_EXT_IO_ODOMETRY_JUMPS_H_

#include <cstdint>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

class OdometryJumps {
 public:
  // A jump exceeds both limits between two readings.
  static constexpr double kMaxDistance = 10.;  // metres
  static constexpr double kMaxSpeed = 50.;     // metres per second

  // (odometry <- robot) without the jumps so far, for readings in order of
  // time: during a jump the robot counts as stationary. Unchanged if there was
  // no jump.
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
