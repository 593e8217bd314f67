// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The velocity of a robot without odometry, from its matched scans: a Kalman
// filter with a random-walk velocity in the robot's frame.
//
// The motion predicted over dt is v dt (with a decaying rotation, see below),
// of covariance P = V dt^2 + S, with S that of a pose. A match that started
// from the prediction, moved the robot by d from it and has the covariance C
// updates the velocity:
//
//   v <- v + K d,   V <- V - K (P - C) K^T,   K = V dt P^-1.
//
// Along a degenerate direction of the scan C is P and d is zero, so the
// velocity does not change; along a poorly observable one d is mostly noise,
// and the difference of two poses would turn it into lasting drift. Between
// scans V grows by the expected change of speed, and the rotation rate decays:
// robots turn in order to drive straight on, and a spurious rotation where the
// scan cannot observe it (inside a round wall) comes to an end.
#ifndef CARTOGRAPHER_EXT_FRONT_END_VELOCITY_FILTER_H_
#define CARTOGRAPHER_EXT_FRONT_END_VELOCITY_FILTER_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// Noise of the velocity.
struct ConstantVelocityOptions {
  // Upper bounds of the change between two scans, whatever the time between
  // them: robots in buildings drive about 1 m/s.
  double speed_noise = 0.5;      // m/s
  double turn_rate_noise = 0.5;  // rad/s
  // Growth of the change with the time between them.
  double acceleration_noise = 1.;       // m/s^2
  double turn_acceleration_noise = 1.;  // rad/s^2
  // A turn is expected to end by itself with this time constant.
  double turn_time = 1.;  // seconds, > 0
  // A velocity holds for this long, a few scans; nothing is known of the rest.
  double max_time = 0.6;  // seconds
};

// Filters the velocity, see above. Not thread-safe.
class VelocityFilter {
 public:
  // Standard deviations of a pose, metres and radians, > 0.
  VelocityFilter(const ConstantVelocityOptions& options,
                 double translation_sigma, double rotation_sigma);

  // Per second; zero at first.
  const Pose2& velocity() const { return velocity_; }

  // v dt, for rotation v T (1 - exp(-dt / T)).
  Pose2 Motion(double interval) const;
  // P above.
  Eigen::Matrix3d MotionCovariance(double interval) const;

  // The match at the end of `interval` (> 0) started from Motion(interval) with
  // MotionCovariance(interval); `covariance` is that of the match, in the frame
  // of the robot at the last scan.
  void AddMatch(double interval, const Pose2& motion,
                const Eigen::Matrix3d& covariance);
  // Adds a change of the forward speed measured by an accelerometer, m/s.
  void Accelerate(double speed_change) { velocity_.x += speed_change; }
  // The match did not start from the prediction: the velocity becomes the
  // difference of the poses.
  void Restart(double interval, const Pose2& motion);

  // The last scan came after a gap and shows much less motion than the velocity
  // before: the robot has slowed down, or the scan is late, measured at the
  // beginning of the gap, and the robot is far ahead of it.
  bool may_be_late() const { return may_be_late_; }
  // Then (robot at the last scan <- robot now), by the velocity before the gap.
  Pose2 MotionAfterLateScan(double interval) const;

 private:
  // Whether the match at the end of `interval` may be that of a late scan.
  void Judge(double interval, const Pose2& motion);
  // As Restart, where nothing is late.
  void Reset(double interval, const Pose2& motion);
  // V at the end of `interval`.
  Eigen::Matrix3d VelocityCovariance(double interval) const;

  const ConstantVelocityOptions options_;
  const Eigen::Matrix3d pose_covariance_;  // S
  Pose2 velocity_;
  Eigen::Matrix3d covariance_;  // V after the last scan
  // Between the last two scans: seconds, what they show, and the velocity before.
  double last_interval_ = 0.;
  Pose2 last_motion_;
  Pose2 velocity_before_;
  bool may_be_late_ = false;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_VELOCITY_FILTER_H_
