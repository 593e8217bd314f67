// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_predictor.h"

#include <cmath>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/front_end/odometry/wheel_reckoning.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A scan may arrive this many median intervals of odometry after the last
// reading, ...
constexpr double kMaxLateness = 1.25;
// ... if the median interval is not longer than this, seconds.
constexpr double kMaxMedianInterval = 0.8;
// A shorter path is that between two scans, metres: what an arc neglects is less
// than what the calibration does not know (play, slip in turns).
constexpr double kLeastReckoned = 3.;

}  // namespace

Eigen::Matrix3d TravelCovariance(const OdometryNoiseOptions& options,
                                 const Pose2& motion,
                                 const double rotation_variance) {
  const double distance = std::hypot(motion.x, motion.y);
  const double along =
      options.translation + options.translation_per_metre * distance;
  const Eigen::Vector2d across =
      distance > 0. ? Eigen::Vector2d(-motion.y / distance, motion.x / distance)
                    : Eigen::Vector2d(0., 1.);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      Squared(along) * Eigen::Matrix2d::Identity() +
      Squared(0.5 * distance) * rotation_variance * across * across.transpose();
  covariance(2, 2) = rotation_variance;
  return covariance;
}

Eigen::Matrix3d Spread(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d d(b.x - a.x, b.y - a.y,
                          NormalizeAngle(b.theta - a.theta));
  return d.cwiseAbs2().asDiagonal();
}

Eigen::Matrix3d OdometryCovariance(const OdometryNoiseOptions& options,
                                   const Pose2& motion) {
  const double rotation =
      options.rotation + options.rotation_per_radian * std::abs(motion.theta) +
      options.rotation_per_metre * std::hypot(motion.x, motion.y);
  return TravelCovariance(options, motion, Squared(rotation));
}

void FuseRotation(const double angle, const double variance,
                  OdometryMotion* const odometry) {
  const double own = odometry->covariance(2, 2);
  const double ratio = own / (own + variance);
  odometry->motion.theta =
      NormalizeAngle(odometry->motion.theta +
                     ratio * NormalizeAngle(angle - odometry->motion.theta));
  odometry->covariance(2, 2) = own * variance / (own + variance);
}

OdometryPredictor::OdometryPredictor(
    const OdometryNoiseOptions& noise, const TimeOffsetOptions& offset,
    const OdometryCalibrationOptions& calibration)
    : noise_(noise),
      buffer_(kOdometryBufferSeconds, kMaxOdometryReadings,
              noise.max_extrapolation),
      offset_(offset),
      calibration_(calibration) {}

bool OdometryPredictor::Predict(const double from, const double to,
                                OdometryMotion* const motion) const {
  const double offset = offset_.offset();
  OdometrySample begin, end;
  if (!buffer_.Lookup(from - offset, &begin) ||
      !buffer_.Lookup(to - offset, &end) ||
      begin.extrapolated > noise_.max_extrapolation) {
    return false;
  }
  *motion = OdometryMotion();
  motion->is_late = end.extrapolated > noise_.max_extrapolation;
  if (motion->is_late) {
    const double interval = buffer_.MedianInterval();
    if (interval > kMaxMedianInterval ||
        end.extrapolated > kMaxLateness * interval) {
      return false;
    }
  }
  motion->raw = Between(begin.pose, end.pose);
  motion->motion = calibration_.Correct(motion->raw);
  motion->frozen = begin.frozen || end.frozen;
  motion->covariance = OdometryCovariance(noise_, motion->motion) +
                       calibration_.Covariance(motion->raw);
  return true;
}

void OdometryPredictor::Reckon(const double from, const double to,
                               const double faults_per_metre,
                               OdometryMotion* const motion) const {
  if (motion->is_late) return;
  const double offset = offset_.offset();
  const ReckonedMotion reckoned =
      ReckonByWheels(buffer_.Steps(from - offset, to - offset), calibration_,
                     faults_per_metre);
  if (reckoned.length < kLeastReckoned) return;
  motion->is_reckoned = true;
  motion->motion = reckoned.motion.pose;
  const Eigen::Matrix3d rotation = PlanarRotation(motion->motion.theta);
  motion->covariance =
      rotation * reckoned.motion.covariance * rotation.transpose();
}

void OdometryPredictor::AddMatch(const double from, const double to,
                                 const Pose2& match) {
  offset_.AddMatch(from, to, match.theta, buffer_);
}

}  // namespace front_end
}  // namespace cartographer_ext
