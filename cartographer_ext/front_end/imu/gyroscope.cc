// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/gyroscope.h"

#include <cmath>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Before the first turn nothing is known of the factor. A MEMS gyroscope that
// was not calibrated at rest has a bias of some degrees a second.
constexpr double kFactorSigma = 1.;
constexpr double kBiasSigma = 0.05;  // rad/s
// Of what the calibration cannot know: temperature, cross axes.
constexpr double kFactorFloor = 0.002;
constexpr double kBiasFloor = 2e-4;  // rad/s
// Matches have errors of 0.1 degrees from one to the next, and the bends of
// walls from submap to submap. `length` of the filter is a time, seconds.
constexpr CalibrationFilter::Noise kNoise = {0.002, 0.002, 2e-4, 4.};
// Jitter of the stamps of scans against those of the IMU, seconds.
constexpr double kStampNoise = 0.02;

// A segment ends after this rotation, radians, or time, seconds.
constexpr double kSegmentRotation = 0.3;
constexpr double kSegmentSeconds = 1.;
// Scans further apart are a gap, seconds.
constexpr double kMaxInterval = 1.;
// A scan measures the rotation if its match has at most this standard
// deviation, radians.
constexpr double kMaxSigma = 0.01;

// Of the factors of sound gyroscopes.
constexpr double kSoundSigma = 0.01;
// A known factor has at most this standard deviation, and a sound one is at most
// this far from one: sensors are calibrated to a few per cent.
constexpr double kKnownFactorSigma = 0.1;
constexpr double kMaxFactorError = 0.25;
// Of the last segments, of which there are at least this many, at most this
// share contradicts a sound gyroscope.
constexpr double kForgetting = 0.98;
constexpr double kMinCompared = 5.;
constexpr double kMaxContradicted = 0.3;

}  // namespace

Gyroscope::Gyroscope(const GyroscopeOptions& options)
    : options_(options),
      headings_(kImuBufferSeconds, kMaxImuReadings, kMaxImuExtrapolation),
      offset_(TimeOffsetOptions()),
      filter_(Eigen::Vector2d(1., 0.),
              Eigen::Vector2d(kFactorSigma, kBiasSigma),
              Eigen::Vector2d(kFactorFloor, kBiasFloor), kNoise) {}

void Gyroscope::Add(const double time, const double yaw_rate) {
  if (has_reading_) {
    heading_ = NormalizeAngle(heading_ + 0.5 * (last_rate_ + yaw_rate) *
                                             (time - last_time_));
  }
  has_reading_ = true;
  last_time_ = time;
  last_rate_ = yaw_rate;
  headings_.Add(time, Pose2(0., 0., heading_));
}

bool Gyroscope::Raw(const double from, const double to,
                    double* const angle) const {
  OdometrySample begin, end;
  const double offset = offset_.offset();
  if (headings_.empty() || !(to > from) ||
      headings_.first_time() > from - offset ||
      headings_.last_time() < to - offset - kMaxImuExtrapolation ||
      !headings_.Lookup(from - offset, &begin) ||
      !headings_.Lookup(to - offset, &end)) {
    return false;
  }
  *angle = NormalizeAngle(end.pose.theta - begin.pose.theta);
  return true;
}

bool Gyroscope::Rotation(const double from, const double to,
                         GyroscopeRotation* const rotation) const {
  double raw;
  if (!Raw(from, to, &raw)) return false;
  const double time = to - from;
  const bool is_proven = state() == GyroscopeState::kProven;
  // Of a proven gyroscope: what the matches tell of the factor, and what the
  // makers of gyroscopes do, weighted by their variances.
  const double learnt = is_proven ? Squared(filter_.sigma(0)) : 1.;
  const double weight = Squared(kSoundSigma) / (Squared(kSoundSigma) + learnt);
  const double factor = 1. + weight * (filter_.value(0) - 1.);
  const double factor_sigma = std::sqrt(weight * learnt);
  rotation->angle = (is_proven ? factor : 1.) * raw + filter_.value(1) * time;
  const double bias_sigma = is_proven ? filter_.sigma(1) : options_.bias_noise;
  rotation->variance = Squared(options_.density) * time +
                       Squared(bias_sigma * time) + Squared(factor_sigma * raw);
  return true;
}

void Gyroscope::AddMatch(const MatchedRotation& matched) {
  double raw;
  if (!Raw(matched.from, matched.to, &raw) || !matched.is_observable ||
      matched.sigma > kMaxSigma || matched.to - matched.from > kMaxInterval) {
    segment_ = Segment();
    filter_.Restart();
    return;
  }
  offset_.AddMatch(matched.from, matched.to, matched.angle, headings_);
  if (!(segment_.end > segment_.start)) segment_.start = matched.from;
  segment_.end = matched.to;
  segment_.angle += matched.angle;
  segment_.turned += std::abs(matched.angle);
  segment_.measured += raw;
  segment_.sigma =
      std::hypot(matched.sigma, kStampNoise / (matched.to - matched.from) *
                                    std::abs(matched.angle));
  if (segment_.turned < kSegmentRotation &&
      segment_.end - segment_.start < kSegmentSeconds) {
    return;
  }
  Learn(segment_);
  segment_ = Segment();
}

void Gyroscope::Learn(const Segment& segment) {
  const double time = segment.end - segment.start;
  const bool agrees = filter_.Add(Eigen::Vector2d(segment.measured, time), time,
                                  segment.angle, segment.sigma);
  compared_ = kForgetting * compared_ + 1.;
  contradicted_ = kForgetting * contradicted_ + (agrees ? 0. : 1.);
}

void Gyroscope::SetBias(const double bias) {
  filter_.Set(1, -bias * filter_.value(0), options_.bias_noise);
}

GyroscopeState Gyroscope::state() const {
  if (compared_ >= kMinCompared &&
      contradicted_ > kMaxContradicted * compared_) {
    return GyroscopeState::kRefuted;
  }
  if (filter_.sigma(0) > kKnownFactorSigma) return GyroscopeState::kUnproven;
  return std::abs(filter_.value(0) - 1.) <= kMaxFactorError
             ? GyroscopeState::kProven
             : GyroscopeState::kRefuted;
}

}  // namespace front_end
}  // namespace cartographer_ext
