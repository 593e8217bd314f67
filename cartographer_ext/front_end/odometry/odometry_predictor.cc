// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_predictor.h"

#include <cmath>
#include <vector>

#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Gaps between scans up to this long are bridged, seconds. A laser of short
// range crosses a hall or a square without a single echo.
constexpr double kBufferSeconds = 3600.;
constexpr size_t kMaxReadings = 20000;
// Longer intervals are not used to estimate the clock offset, seconds.
constexpr double kMaxOffsetInterval = 1.;
// Matches waiting for later odometry.
constexpr size_t kMaxPending = 20;
// A scan may arrive this many median intervals of odometry after the last
// reading, ...
constexpr double kMaxLateness = 1.25;
// ... if the median interval is not longer than this, seconds.
constexpr double kMaxMedianInterval = 0.8;

}  // namespace

Eigen::Matrix3d OdometryCovariance(const OdometryNoiseOptions& options,
                                   const Pose2& motion) {
  const double distance = std::hypot(motion.x, motion.y);
  const double along =
      options.translation + options.translation_per_metre * distance;
  const double rotation = options.rotation +
                          options.rotation_per_radian * std::abs(motion.theta) +
                          options.rotation_per_metre * distance;
  const Eigen::Vector2d across =
      distance > 0. ? Eigen::Vector2d(-motion.y / distance, motion.x / distance)
                    : Eigen::Vector2d(0., 1.);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      Squared(along) * Eigen::Matrix2d::Identity() +
      Squared(0.5 * distance * rotation) * across * across.transpose();
  covariance(2, 2) = Squared(rotation);
  return covariance;
}

OdometryPredictor::OdometryPredictor(
    const OdometryNoiseOptions& noise, const TimeOffsetOptions& offset,
    const OdometryCalibrationOptions& calibration)
    : noise_(noise),
      buffer_(kBufferSeconds, kMaxReadings, noise.max_extrapolation),
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
  if (offset_.candidates().empty() || !(to > from) ||
      to - from > kMaxOffsetInterval) {
    return;
  }
  pending_.push_back({from, to, match.theta});
  while (!pending_.empty()) {
    const MatchedTurn& oldest = pending_.front();
    const bool is_covered =
        !buffer_.empty() &&
        buffer_.last_time() >= oldest.to - offset_.candidates().front() &&
        buffer_.first_time() <= oldest.from - offset_.candidates().back();
    if (is_covered) {
      LearnOffset(oldest);
    } else if (pending_.size() <= kMaxPending) {
      return;
    }
    pending_.pop_front();
  }
}

void OdometryPredictor::LearnOffset(const MatchedTurn& matched) {
  std::vector<double> turns;
  turns.reserve(offset_.candidates().size());
  for (const double offset : offset_.candidates()) {
    OdometrySample begin, end;
    buffer_.Lookup(matched.from - offset, &begin);
    buffer_.Lookup(matched.to - offset, &end);
    turns.push_back(NormalizeAngle(end.pose.theta - begin.pose.theta));
  }
  offset_.Add(matched.turn, turns);
}

}  // namespace front_end
}  // namespace cartographer_ext
