// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_predictor.h"

#include <cmath>

#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A scan may arrive this many median intervals of odometry after the last
// reading, ...
constexpr double kMaxLateness = 1.25;
// ... if the median interval is not longer than this, seconds.
constexpr double kMaxMedianInterval = 0.8;

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

Eigen::Matrix3d OdometryCovariance(const OdometryNoiseOptions& options,
                                   const Pose2& motion) {
  const double rotation =
      options.rotation + options.rotation_per_radian * std::abs(motion.theta) +
      options.rotation_per_metre * std::hypot(motion.x, motion.y);
  return TravelCovariance(options, motion, Squared(rotation));
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

void OdometryPredictor::AddMatch(const double from, const double to,
                                 const Pose2& match) {
  offset_.AddMatch(from, to, match.theta, buffer_);
}

}  // namespace front_end
}  // namespace cartographer_ext
