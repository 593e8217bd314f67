// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A small recording for tests, made without files: a robot drives laps along
// the walls of an eight by six metre room with a box in it, ten scans a second,
// and knows its odometry exactly.
#ifndef TESTS_SLAM_ROOM_SOURCE_H_
#define TESTS_SLAM_ROOM_SOURCE_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace test {

class RoomSource : public io::SensorSource {
 public:
  static constexpr io::TimeNs kStart = 1000LL * 1000000000LL;
  static constexpr io::TimeNs kStep = 100000000LL;

  explicit RoomSource(int num_scans, bool with_odometry = true)
      : num_scans_(num_scans), with_odometry_(with_odometry) {
    info_.format = "test";
    info_.num_scans = num_scans;
    info_.num_odometry = with_odometry ? num_scans : 0;
    info_.begin = kStart;
    info_.end = kStart + (num_scans - 1) * kStep;
  }

  const io::SensorSourceInfo& info() const override { return info_; }

  absl::StatusOr<bool> Next(io::SensorEvent* event) override {
    if (index_ == num_scans_) return false;
    const io::TimeNs time = kStart + index_ * kStep;
    const Pose2 pose = TruePose(index_);
    if (with_odometry_ && !odometry_given_) {
      odometry_given_ = true;
      io::OdometryReading reading;
      reading.time = time;
      reading.pose = pose;
      *event = reading;
      return true;
    }
    odometry_given_ = false;
    ++index_;
    *event = Scan(time, pose);
    return true;
  }

  // (room <- robot), once round an ellipse in 40 s; the origin of the room is
  // its centre.
  static Pose2 TruePose(int index) {
    const double angle = 2. * kPi * index / 400.;
    return Pose2(2.5 * std::cos(angle), 1.8 * std::sin(angle),
                 NormalizeAngle(std::atan2(1.8 * std::cos(angle),
                                           -2.5 * std::sin(angle))));
  }

  static io::LaserScan Scan(io::TimeNs time, const Pose2& pose) {
    io::LaserScan scan;
    scan.time = time;
    scan.angle_min = -kPi / 2.;
    scan.angle_increment = kPi / 180.;
    scan.range_min = 0.05;
    scan.range_max = 20.;
    for (int i = 0; i < 180; ++i) {
      scan.ranges.push_back(static_cast<float>(
          Range(pose, scan.angle_min + i * scan.angle_increment)));
    }
    return scan;
  }

 private:
  static double Range(const Pose2& pose, double angle) {
    const double dx = std::cos(pose.theta + angle);
    const double dy = std::sin(pose.theta + angle);
    double range = std::numeric_limits<double>::infinity();
    // Walls seen from inside.
    if (dx != 0.) range = std::min(range, ((dx > 0. ? 4. : -4.) - pose.x) / dx);
    if (dy != 0.) range = std::min(range, ((dy > 0. ? 3. : -3.) - pose.y) / dy);
    // The box from (-0.4, -0.3) to (0.9, 0.5) seen from outside.
    double enter = 0., leave = range;
    const double low[] = {-0.4, -0.3}, high[] = {0.9, 0.5};
    const double from[] = {pose.x, pose.y}, towards[] = {dx, dy};
    for (int axis = 0; axis < 2; ++axis) {
      if (towards[axis] == 0.) {
        if (from[axis] < low[axis] || from[axis] > high[axis]) return range;
        continue;
      }
      const double a = (low[axis] - from[axis]) / towards[axis];
      const double b = (high[axis] - from[axis]) / towards[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? enter : range;
  }

  const int num_scans_;
  const bool with_odometry_;
  io::SensorSourceInfo info_;
  int index_ = 0;
  bool odometry_given_ = false;
};

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_SLAM_ROOM_SOURCE_H_
