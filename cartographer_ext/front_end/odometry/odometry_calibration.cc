// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Matches of scans that determine the whole pose have errors of some
// millimetres from one to the next, and of 6 to 8 mm per root metre from submap
// to submap (simulated offices and corridors against ground truth).
constexpr CalibrationFilter::Noise kTranslationNoise = {0.01, 0.008, 3e-5, 4.,
                                                        5.};
// The same for rotation, 0.1 degrees. The noise that grows with distance is
// that of the wheels: 4 mm per root metre of each wheel, 40 cm apart, are 0.8
// degrees.
constexpr CalibrationFilter::Noise kRotationNoise = {0.002, 0.015, 3e-5, 4.,
                                                     5.};
// Metres that the wheels roll while the robot turns on the spot by a radian.
constexpr double kWheelRadius = 0.2;
// Standard deviations of the scale of whole maps, and of other errors common to
// all matches.
constexpr double kTranslationFloor = 0.001;
constexpr double kRotationFloor = 0.002;
constexpr double kRotationPerMetreFloor = 0.0002;
// Jitter of the stamps of scans against those of odometry, seconds.
constexpr double kStampNoise = 0.02;

// A segment ends after this distance, metres, or rotation, radians.
constexpr double kSegmentLength = 0.5;
constexpr double kSegmentRotation = 0.5;
// Scans further apart are a gap, seconds, unless the recording has no others: then
// those that are twice as far apart as the median of so many.
constexpr double kMaxInterval = 1.;
constexpr double kUsualIntervals = 2.;
constexpr size_t kNumIntervals = 15;
// A scan measures the translation (rotation) if its match has at most this
// standard deviation, metres (radians).
constexpr double kMaxTranslationSigma = 0.012;
constexpr double kMaxRotationSigma = 0.006;
// A fault may have begun this long before it is detected, seconds.
constexpr double kSettleTime = 3.;
constexpr size_t kMaxPending = 100;

double Clamped(const double value, const double initial, const double most) {
  return std::min(initial + most, std::max(initial - most, value));
}

// What the wheels roll over a path, metres.
double WheelPath(const double length, const double rotation) {
  return length + kWheelRadius * rotation;
}

// Direction of a motion on an arc, in the frame of its start.
Eigen::Vector2d Forward(const Pose2& motion) {
  return Eigen::Vector2d(std::cos(0.5 * motion.theta),
                         std::sin(0.5 * motion.theta));
}

// Signed length of a motion.
double SignedDistance(const Pose2& motion) {
  return motion.translation().dot(Forward(motion));
}

}  // namespace

OdometryCalibration::OdometryCalibration(
    const OdometryCalibrationOptions& options)
    : options_(options),
      translation_filter_(Eigen::Vector2d(options.translation_scale, 0.),
                          Eigen::Vector2d(options.estimate_odometry_scale
                                              ? options.translation_scale_sigma
                                              : 0.,
                                          0.),
                          Eigen::Vector2d(kTranslationFloor, 0.),
                          kTranslationNoise),
      rotation_filter_(
          Eigen::Vector2d(1. / options.rotation_scale,
                          -options.rotation_per_metre / options.rotation_scale),
          options.estimate_rotation
              ? Eigen::Vector2d(options.rotation_scale_sigma,
                                options.rotation_per_metre_sigma)
              : Eigen::Vector2d(0., 0.),
          Eigen::Vector2d(kRotationFloor, kRotationPerMetreFloor),
          kRotationNoise) {}

void OdometryCalibration::Discard(const double time) {
  current_ = Segment();
  pending_.clear();
  must_restart_ = true;
  has_fault_ = true;
  fault_time_ = time;
}

bool OdometryCalibration::IsGap(const double interval) {
  if (interval <= kMaxInterval) return false;
  if (intervals_.size() < kNumIntervals) return true;
  return interval >
         kUsualIntervals * UpperMedian(std::vector<double>(intervals_.begin(),
                                                           intervals_.end()));
}

double OdometryCalibration::TranslationVariance(const double length) const {
  return translation_filter_.noise_factor() * Squared(kTranslationNoise.walk) *
         length;
}

double OdometryCalibration::RotationVariance(const double length,
                                             const double rotation) const {
  return rotation_filter_.noise_factor() * Squared(kRotationNoise.walk) *
         WheelPath(length, rotation);
}

double OdometryCalibration::translation_scale_sigma() const {
  return translation_filter_.sigma(0);
}

double OdometryCalibration::rotation_scale_sigma() const {
  return Squared(rotation_scale()) * rotation_filter_.sigma(0);
}

double OdometryCalibration::rotation_per_metre_sigma() const {
  return rotation_scale() * rotation_filter_.sigma(1);
}

void OdometryCalibration::Add(const CalibrationInterval& interval) {
  if (!options_.estimate_odometry_scale && !options_.estimate_rotation) return;
  bool is_usable = interval.is_sound && interval.interval > 0.;
  if (is_usable) {
    is_usable = !IsGap(interval.interval);
    intervals_.push_back(interval.interval);
    if (intervals_.size() > kNumIntervals) intervals_.pop_front();
  }
  if (!is_usable) {
    Discard(interval.time);
    return;
  }
  if (has_fault_ && interval.time - fault_time_ < kSettleTime) return;
  has_fault_ = false;

  const double distance = SignedDistance(interval.odometry);
  const double rotation = interval.odometry.theta;
  current_.time = interval.time;
  current_.odometry_translation += distance;
  current_.odometry_rotation += rotation;
  current_.matched_translation += SignedDistance(interval.match);
  current_.matched_rotation += interval.match.theta;
  current_.length += std::abs(distance);
  current_.rotation += std::abs(rotation);
  const Eigen::Vector2d forward = Forward(interval.match);
  const double translation_sigma = std::sqrt(std::max(
      0., forward.dot(interval.covariance.topLeftCorner<2, 2>() * forward)));
  const double rotation_sigma =
      std::sqrt(std::max(0., interval.covariance(2, 2)));
  current_.translation_observable = current_.translation_observable &&
                                    interval.translation_observable &&
                                    translation_sigma <= kMaxTranslationSigma;
  current_.rotation_observable = current_.rotation_observable &&
                                 interval.rotation_observable &&
                                 rotation_sigma <= kMaxRotationSigma;
  const double stamp = kStampNoise / interval.interval;
  current_.translation_sigma = std::hypot(translation_sigma, stamp * distance);
  current_.rotation_sigma = std::hypot(rotation_sigma, stamp * rotation);
  if (current_.length < kSegmentLength &&
      current_.rotation < kSegmentRotation) {
    return;
  }
  pending_.push_back(current_);
  current_ = Segment();
  while (!pending_.empty() &&
         (interval.time - pending_.front().time >= kSettleTime ||
          pending_.size() > kMaxPending)) {
    Learn(pending_.front());
    pending_.pop_front();
  }
}

void OdometryCalibration::Learn(const Segment& segment) {
  if (must_restart_) {
    translation_filter_.Restart();
    rotation_filter_.Restart();
    must_restart_ = false;
  }
  if (segment.translation_observable) {
    translation_filter_.Add(Eigen::Vector2d(segment.odometry_translation, 0.),
                            segment.length, segment.matched_translation,
                            segment.translation_sigma);
  } else {
    translation_filter_.Restart();
  }
  if (segment.rotation_observable) {
    rotation_filter_.Add(
        Eigen::Vector2d(segment.matched_rotation, segment.odometry_translation),
        WheelPath(segment.length, segment.rotation), segment.odometry_rotation,
        segment.rotation_sigma);
  } else {
    rotation_filter_.Restart();
  }
}

double OdometryCalibration::translation_scale() const {
  return Clamped(translation_filter_.value(0), options_.translation_scale,
                 options_.max_deviation);
}

double OdometryCalibration::rotation_scale() const {
  return Clamped(1. / rotation_filter_.value(0), options_.rotation_scale,
                 options_.max_deviation);
}

double OdometryCalibration::rotation_per_metre() const {
  return Clamped(-rotation_filter_.value(1) / rotation_filter_.value(0),
                 options_.rotation_per_metre, options_.max_deviation);
}

Pose2 OdometryCalibration::Correct(const Pose2& odometry) const {
  const double rotation = rotation_scale() * odometry.theta +
                          rotation_per_metre() * SignedDistance(odometry);
  // On an arc the chord turns by half of the change.
  const Pose2 bend(0., 0., 0.5 * (rotation - odometry.theta));
  const Eigen::Vector2d translation =
      translation_scale() * (bend * odometry.translation());
  return Pose2(translation.x(), translation.y(), NormalizeAngle(rotation));
}

Eigen::Matrix3d OdometryCalibration::Covariance(const Pose2& odometry) const {
  const double distance = SignedDistance(odometry);
  const double rotation_variance =
      Squared(rotation_scale_sigma() * odometry.theta) +
      Squared(rotation_per_metre_sigma() * distance);
  const Eigen::Vector2d forward = Forward(odometry);
  const Eigen::Vector2d across(-forward.y(), forward.x());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      Squared(translation_scale_sigma() * distance) * forward *
          forward.transpose() +
      Squared(0.5 * distance) * rotation_variance * across * across.transpose();
  covariance(2, 2) = rotation_variance;
  return covariance;
}

}  // namespace front_end
}  // namespace cartographer_ext
