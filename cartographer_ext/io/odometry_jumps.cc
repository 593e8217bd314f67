// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/odometry_jumps.h"

#include <cmath>

namespace cartographer_ext {
namespace io {

constexpr double OdometryJumps::kMaxDistance;
constexpr double OdometryJumps::kMaxSpeed;

Pose2 OdometryJumps::Remove(const TimeNs time, const Pose2& pose) {
  const double distance =
      has_last_ ? std::hypot(pose.x - last_raw_.x, pose.y - last_raw_.y) : 0.;
  if (distance > kMaxDistance &&
      distance > kMaxSpeed * ToSeconds(time - last_time_)) {
    correction_ = correction_ * last_raw_ * pose.Inverse();
    if (count_++ == 0) {
      first_time_ = time;
      first_distance_ = distance;
    }
  }
  has_last_ = true;
  last_time_ = time;
  last_raw_ = pose;
  return count_ == 0 ? pose : correction_ * pose;
}

}  // namespace io
}  // namespace cartographer_ext
