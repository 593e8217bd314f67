// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The last odometry readings, with lookup of the pose at any time.
//
// Between two readings the pose is interpolated (linearly in translation, along
// the shorter arc in angle). After the last one it is extrapolated with the
// velocity of the last tenth of a second, for a bounded time, because a scan
// may arrive one message before the odometry of its stamp. Before the first one
// it is the first.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_BUFFER_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_BUFFER_H_

#include <cstddef>
#include <deque>
#include <vector>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// The pose at one time.
struct OdometrySample {
  Pose2 pose;  // (odometry <- robot)
  // Seconds from `time` to the nearest reading if it is before the first or
  // after the last one; 0 in between.
  double extrapolated = 0.;
  // The readings around `time` have the same pose: stationary, or stale.
  bool frozen = false;
};

// The least that is no motion of the robot between two readings: the distance at
// this speed, or the angle at this rate.
struct OdometryJump {
  double distance = 0.;   // metres
  double angle = 0.;      // radians
  double speed = 0.;      // m/s
  double turn_rate = 0.;  // rad/s
};

// The buffer, see above. Not thread-safe.
class OdometryBuffer {
 public:
  // Keeps the readings of the last `seconds`, and `max_readings` at most: of
  // more, every second one of the older half is dropped.
  OdometryBuffer(double seconds, size_t max_readings, double max_extrapolation);

  // Seconds and (odometry <- robot). Returns false and ignores the reading
  // unless it is finite and later than the last one.
  bool Add(double time, const Pose2& pose);

  // False without readings.
  bool Lookup(double time, OdometrySample* sample) const;

  // The motions from reading to reading between two times, of the first and the
  // last the parts in between; empty without readings. Each is (robot <- robot at
  // the next).
  std::vector<Pose2> Steps(double from, double to) const;

  // Whether two successive readings are as far apart as a jump, of those between
  // which the interval from `from` to `to` lies, or a part of it.
  bool HasJump(double from, double to, const OdometryJump& jump) const;

  // Whether any two readings so far differed.
  bool has_moved() const { return has_moved_; }

  // Median time between the last readings, seconds; 0 with fewer than two.
  double MedianInterval() const;

  bool empty() const { return readings_.empty(); }
  double first_time() const { return readings_.front().time; }
  double last_time() const { return readings_.back().time; }

 private:
  struct Reading {
    double time;
    Pose2 pose;
  };

  std::deque<Reading>::const_iterator FirstAfter(double time) const;
  Pose2 Extrapolate(double seconds) const;
  void Thin();

  const double seconds_;
  const size_t max_readings_;
  const double max_extrapolation_;
  std::deque<Reading> readings_;
  bool has_moved_ = false;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_BUFFER_H_
