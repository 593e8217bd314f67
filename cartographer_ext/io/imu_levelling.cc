// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/imu_levelling.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Geometry"

namespace cartographer_ext {
namespace io {
namespace {

// The mean of this long, of all readings as long as there are fewer, seconds.
constexpr double kTimeConstant = 10.;
// Sizes of the mean that are gravity, m/s^2.
constexpr double kMinGravity = 8.;
constexpr double kMaxGravity = 12.;
// Cosine of the largest tilt of a mount with known horizontal axes: 30 degrees.
constexpr double kMinUpright = 0.866;

}  // namespace

ImuReading ImuLevelling::Level(const ImuReading& reading) {
  if (!reading.linear_acceleration.allFinite() ||
      !reading.angular_velocity.allFinite()) {
    return reading;
  }
  if (!has_gravity_) {
    has_gravity_ = true;
    gravity_ = reading.linear_acceleration;
    first_time_ = reading.time;
  } else {
    const double interval = ToSeconds(reading.time - last_time_);
    const double age = ToSeconds(reading.time - first_time_);
    const double span = std::min(kTimeConstant, std::max(age, interval));
    const double rate =
        span > 0. ? std::min(1., std::max(0., interval) / span) : 0.;
    gravity_ += rate * (reading.linear_acceleration - gravity_);
  }
  last_time_ = reading.time;

  ImuReading level = reading;
  const double size = gravity_.norm();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (!(size >= kMinGravity && size <= kMaxGravity)) {
    level.linear_acceleration = kGravity * up;
    return level;
  }
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond::FromTwoVectors(gravity_, up);
  level.angular_velocity = rotation * reading.angular_velocity;
  level.linear_acceleration = kGravity * up;
  if (gravity_.z() >= kMinUpright * size) {
    level.linear_acceleration.head<2>() =
        (rotation * reading.linear_acceleration).head<2>();
  }
  return level;
}

}  // namespace io
}  // namespace cartographer_ext
