// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/imu_tracker.h"

#include <cmath>

#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

ImuTracker::ImuTracker(const double imu_gravity_time_constant,
                       const common::Time time)
    : imu_gravity_time_constant_(imu_gravity_time_constant), time_(time) {}

void ImuTracker::Advance(const common::Time time) {
  CHECK_LE(time_, time);
  const Eigen::Vector3d angle_axis =
      imu_angular_velocity_ * common::ToSeconds(time - time_);
  const Eigen::Quaterniond turn =
      transform::AngleAxisVectorToRotationQuaternion(angle_axis);
  orientation_ = (orientation_ * turn).normalized();
  // In the frame of the body, gravity rotates the opposite way.
  gravity_vector_ = turn.conjugate() * gravity_vector_;
  time_ = time;
}

void ImuTracker::AddImuLinearAccelerationObservation(
    const Eigen::Vector3d& imu_linear_acceleration) {
  if (!imu_linear_acceleration.allFinite() ||
      imu_linear_acceleration.isZero(0.)) {
    return;
  }
  // The first observation counts fully, later ones by the time they cover.
  double weight = 1.;
  if (last_linear_acceleration_time_ != common::Time::min()) {
    const double elapsed_seconds =
        common::ToSeconds(time_ - last_linear_acceleration_time_);
    weight = 1. - std::exp(-elapsed_seconds / imu_gravity_time_constant_);
  }
  last_linear_acceleration_time_ = time_;
  gravity_vector_ =
      (1. - weight) * gravity_vector_ + weight * imu_linear_acceleration;
  // Tilts the estimate by the smallest turn that brings the filtered gravity
  // upright.
  const Eigen::Vector3d expected =
      orientation_.conjugate() * Eigen::Vector3d::UnitZ();
  orientation_ = (orientation_ *
                  Eigen::Quaterniond::FromTwoVectors(gravity_vector_, expected))
                     .normalized();
}

void ImuTracker::AddImuAngularVelocityObservation(
    const Eigen::Vector3d& imu_angular_velocity) {
  if (imu_angular_velocity.allFinite()) {
    imu_angular_velocity_ = imu_angular_velocity;
  }
}

}  // namespace mapping
}  // namespace cartographer
