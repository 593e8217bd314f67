// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Attitude from gyroscope and accelerometer: rotation rates are integrated, and
// a slow low-pass filter over the measured acceleration says where "up" is.
#ifndef CARTOGRAPHER_MAPPING_IMU_TRACKER_H_
#define CARTOGRAPHER_MAPPING_IMU_TRACKER_H_

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer/common/time.h"

namespace cartographer {
namespace mapping {

class ImuTracker {
 public:
  // `imu_gravity_time_constant` in seconds: the larger, the less a short
  // acceleration of the robot tilts the estimate.
  ImuTracker(double imu_gravity_time_constant, common::Time time);

  // Integrates the newest rotation rate up to `time`, which must not be earlier
  // than time().
  void Advance(common::Time time);

  // Both belong to the current time(). Accelerations without a direction (zero
  // or not finite) are ignored.
  void AddImuLinearAccelerationObservation(
      const Eigen::Vector3d& imu_linear_acceleration);
  void AddImuAngularVelocityObservation(
      const Eigen::Vector3d& imu_angular_velocity);

  common::Time time() const { return time_; }
  // (gravity aligned <- tracking); yaw is relative to where tracking began.
  Eigen::Quaterniond orientation() const { return orientation_; }

 private:
  const double imu_gravity_time_constant_;
  common::Time time_;
  common::Time last_linear_acceleration_time_ = common::Time::min();
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gravity_vector_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d imu_angular_velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_IMU_TRACKER_H_
