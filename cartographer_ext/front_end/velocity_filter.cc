// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/velocity_filter.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Initial standard deviation of the rotation rate, rad/s: robots seldom start
// while they turn fast.
constexpr double kInitialTurnRateSigma = 0.2;

// A scan is late after a gap of this many intervals, up to this long, if the motion
// that it shows falls short of that by the velocity by so much.
constexpr double kGapRatio = 1.5;
constexpr double kLongestStall = 2.;      // seconds
constexpr double kMissedDistance = 0.15;  // metres
constexpr double kMissedAngle = 0.15;     // radians

Pose2 AtVelocity(const Pose2& velocity, const double interval) {
  const Pose2 direction(0., 0., std::atan2(velocity.y, velocity.x));
  return direction *
         ArcPose(velocity.translation().norm() * interval,
                 velocity.theta * interval) *
         direction.Inverse();
}

// How far apart two motions are, in what makes a scan late.
double Missed(const Pose2& a, const Pose2& b) {
  const Pose2 off = Between(a, b);
  return off.translation().norm() / kMissedDistance +
         std::abs(NormalizeAngle(off.theta)) / kMissedAngle;
}

// Covariance of the change of the velocity over `interval`, per second squared.
Eigen::Matrix3d Change(const ConstantVelocityOptions& options,
                       const double interval) {
  const double speed =
      std::min(options.speed_noise, options.acceleration_noise * interval);
  const double turn = std::min(options.turn_rate_noise,
                               options.turn_acceleration_noise * interval);
  return Eigen::Vector3d(speed * speed, speed * speed, turn * turn)
      .asDiagonal();
}

Eigen::Matrix3d Largest(const ConstantVelocityOptions& options) {
  return Eigen::Vector3d(options.speed_noise * options.speed_noise,
                         options.speed_noise * options.speed_noise,
                         options.turn_rate_noise * options.turn_rate_noise)
      .asDiagonal();
}

}  // namespace

VelocityFilter::VelocityFilter(const ConstantVelocityOptions& options,
                               const double translation_sigma,
                               const double rotation_sigma)
    : options_(options),
      pose_covariance_(Eigen::Vector3d(translation_sigma * translation_sigma,
                                       translation_sigma * translation_sigma,
                                       rotation_sigma * rotation_sigma)
                           .asDiagonal()),
      covariance_(Largest(options)) {
  covariance_(2, 2) = std::min(covariance_(2, 2),
                               kInitialTurnRateSigma * kInitialTurnRateSigma);
}

Pose2 VelocityFilter::Motion(const double interval) const {
  const double time = options_.turn_time;
  return Pose2(velocity_.x * interval, velocity_.y * interval,
               velocity_.theta * time * -std::expm1(-interval / time));
}

Eigen::Matrix3d VelocityFilter::VelocityCovariance(
    const double interval) const {
  return covariance_ + Change(options_, interval);
}

Eigen::Matrix3d VelocityFilter::MotionCovariance(const double interval) const {
  return interval * interval * VelocityCovariance(interval) + pose_covariance_;
}

void VelocityFilter::Judge(const double interval, const Pose2& motion) {
  const Pose2 expected = AtVelocity(velocity_, interval);
  const bool is_gap =
      interval > kGapRatio * last_interval_ && interval < kLongestStall;
  const bool is_short =
      expected.translation().norm() - motion.translation().norm() >
          kMissedDistance ||
      std::abs(expected.theta) - std::abs(motion.theta) > kMissedAngle;
  may_be_late_ = last_interval_ > 0. && is_gap && is_short;
  velocity_before_ = velocity_;
  last_motion_ = motion;
  last_interval_ = interval;
}

Pose2 VelocityFilter::MotionAfterLateScan(const double interval) const {
  return Between(last_motion_,
                 AtVelocity(velocity_before_, last_interval_ + interval));
}

void VelocityFilter::AddMatch(const double interval, const Pose2& motion,
                              const Eigen::Matrix3d& covariance) {
  if (may_be_late_) {
    Restart(interval, motion);
    return;
  }
  Judge(interval, motion);
  const Pose2 predicted = Motion(interval);
  const Eigen::Vector3d off(motion.x - predicted.x, motion.y - predicted.y,
                            NormalizeAngle(motion.theta - predicted.theta));
  const Eigen::Matrix3d before = VelocityCovariance(interval);
  const Eigen::Matrix3d p = MotionCovariance(interval);
  const Eigen::Matrix3d gain = interval * p.ldlt().solve(before).transpose();
  const Eigen::Vector3d change = gain * off;
  const Eigen::Matrix3d after =
      Symmetric(before - gain * (p - covariance) * gain.transpose());
  if (!change.allFinite() || !after.allFinite()) {
    Reset(interval, motion);
    return;
  }
  velocity_.x += change.x();
  velocity_.y += change.y();
  velocity_.theta *= std::exp(-interval / options_.turn_time);
  velocity_.theta += change.z();
  covariance_ = after;
  // Variances stay between zero and their initial values.
  const Eigen::Vector3d largest = Largest(options_).diagonal();
  for (int k = 0; k < 3; ++k) {
    if (after(k, k) >= 0. && after(k, k) <= largest(k)) continue;
    covariance_.row(k).setZero();
    covariance_.col(k).setZero();
    covariance_(k, k) = largest(k);
  }
}

void VelocityFilter::Restart(const double interval, const Pose2& motion) {
  Pose2 own = motion;
  if (may_be_late_ && Missed(motion, MotionAfterLateScan(interval)) <
                          Missed(motion, AtVelocity(velocity_, interval))) {
    // It was late: of the motion only the last part belongs to the interval.
    own = Between(MotionAfterLateScan(0.), motion);
  }
  Judge(interval, own);
  Reset(interval, own);
}

void VelocityFilter::Reset(const double interval, const Pose2& motion) {
  velocity_ =
      Pose2(motion.x / interval, motion.y / interval, motion.theta / interval);
  covariance_ = 2. / (interval * interval) * pose_covariance_;
  const Eigen::Matrix3d largest = Largest(options_);
  covariance_ = covariance_.cwiseMin(largest);
}

}  // namespace front_end
}  // namespace cartographer_ext
