// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The velocity of a robot without odometry, from its matched scans: a Kalman
// filter over a velocity that changes by chance, robot's frame.
//
// The motion predicted over dt is v dt (less for the turn, see below), with
// covariance P = V dt^2 + S, S that of a pose. A match that began there, put
// the robot d beside it and left the covariance C, tells of the velocity
//
//   v <- v + K d,   V <- V - K (P - C) K^T,   K = V dt P^-1.
//
// Where the scan leaves a direction open, C is P, d is nothing, and the
// velocity stays what it was; where it tells little, d is mostly chance, and
// the plain difference of two poses would make a lasting drift of it. Between
// scans V grows by the change of speed that is to be expected, and the turn
// rate dies away: robots turn to go straight again, and a turn that was begun
// by mistake where the scan does not tell (within a round wall) comes to an
// end.
#ifndef CARTOGRAPHER_EXT_FRONT_END_VELOCITY_FILTER_H_
#define CARTOGRAPHER_EXT_FRONT_END_VELOCITY_FILTER_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

struct ConstantVelocityOptions {
  // Of the change between two scans, at most.
  double speed_noise = 0.5;      // m/s
  double turn_rate_noise = 0.5;  // rad/s
  // That grows with the time between them.
  double acceleration_noise = 1.;       // m/s^2
  double turn_acceleration_noise = 1.;  // rad/s^2
  double turn_time = 1.;                // seconds, > 0
  double max_time = 0.6;                // seconds
};

class VelocityFilter {
 public:
  // Standard deviations of a pose, metres and radians, > 0.
  VelocityFilter(const ConstantVelocityOptions& options,
                 double translation_sigma, double rotation_sigma);

  // Per second; zero at first.
  const Pose2& velocity() const { return velocity_; }

  // v dt, the turn v T (1 - exp(-dt / T)), whatever dt.
  Pose2 Motion(double interval) const;
  // P above.
  Eigen::Matrix3d MotionCovariance(double interval) const;

  // The match at the end of `interval` (> 0) began at Motion(interval)
  // with MotionCovariance(interval); `covariance` is what it left, in the frame
  // of the robot before.
  void AddMatch(double interval, const Pose2& motion,
                const Eigen::Matrix3d& covariance);
  // An accelerometer told a change of the speed forwards, metres a second.
  void Accelerate(double speed_change) { velocity_.x += speed_change; }
  // It began elsewhere: the velocity is the difference of the poses.
  void Restart(double interval, const Pose2& motion);

 private:
  // V at the end of `interval`.
  Eigen::Matrix3d VelocityCovariance(double interval) const;

  const ConstantVelocityOptions options_;
  const Eigen::Matrix3d pose_covariance_;  // S
  Pose2 velocity_;
  Eigen::Matrix3d covariance_;  // V after the last scan
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_VELOCITY_FILTER_H_
