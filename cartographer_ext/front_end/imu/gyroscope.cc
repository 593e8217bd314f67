// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/gyroscope.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Matches have errors of 0.1 degrees from one to the next, and the bends of
// walls from submap to submap. `length` of the filter is a time, seconds.
constexpr CalibrationFilter::Noise kNoise = {0.002, 0.002, 2e-4, 4.};
// Wheels drift by a degree a second and more.
constexpr CalibrationFilter::Noise kWheelNoise = {0.01, 0.03, 2e-4, 4.};
// Wheels that turn by less in a stretch are at rest, radians.
constexpr double kRestAngle = 1e-4;
// Jitter of the stamps of scans against those of the IMU, seconds.
constexpr double kStampNoise = 0.02;

// A segment ends after this rotation, radians, or time, seconds.
constexpr double kSegmentRotation = 0.3;
constexpr double kSegmentSeconds = 1.;
// Least age of the map that a scan sees, seconds.
constexpr double kMinMapAge = 0.5;
// Scans further apart are a gap, seconds.
constexpr double kMaxInterval = 1.;
// A scan measures the rotation if its match has at most this standard
// deviation, radians.
constexpr double kMaxSigma = 0.01;

// Of the factors of sound gyroscopes.
constexpr double kSoundSigma = 0.01;

}  // namespace

Gyroscope::Gyroscope(const GyroscopeOptions& options)
    : options_(options),
      headings_(kImuBufferSeconds, kMaxImuReadings, kMaxImuExtrapolation),
      offset_(TimeOffsetOptions()),
      scans_(kNoise, false),
      wheels_(kWheelNoise, true) {}

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

const RotationCheck* Gyroscope::Proof() const {
  if (scans_.state() == GyroscopeState::kProven) return &scans_;
  // Scans that contradict a gyroscope which agrees with the wheels are wrong.
  const bool is_open =
      scans_.state() == GyroscopeState::kUnproven || !scans_.factor_is_known();
  return is_open && wheels_.state() == GyroscopeState::kProven ? &wheels_
                                                               : nullptr;
}

GyroscopeState Gyroscope::state() const {
  return Proof() != nullptr ? GyroscopeState::kProven : scans_.state();
}

bool Gyroscope::Rotation(const double from, const double to,
                         GyroscopeRotation* const rotation) const {
  double raw;
  if (!Raw(from, to, &raw)) return false;
  const GyroscopeCorrection correction = Correction();
  rotation->angle = correction.Angle(raw, to - from);
  rotation->variance = correction.Variance(raw, to - from);
  return true;
}

GyroscopeCorrection Gyroscope::Correction() const {
  GyroscopeCorrection correction;
  const RotationCheck* const proof = Proof();
  const bool by_scans = proof == &scans_;
  // What the matches tell of the factor, and what the makers of gyroscopes do,
  // weighted by their variances.
  const double learnt = by_scans ? Squared(scans_.factor_sigma()) : 1.;
  const double weight = Squared(kSoundSigma) / (Squared(kSoundSigma) + learnt);
  if (by_scans) correction.factor += weight * (scans_.factor() - 1.);
  correction.factor_variance = weight * learnt;
  const RotationCheck::Drift drift =
      (proof == nullptr ? scans_ : *proof).EstimateDrift();
  correction.drift = drift.value;
  correction.drift_variance =
      proof == nullptr ? Squared(options_.bias_noise) : drift.variance;
  correction.density_squared = Squared(options_.density);
  return correction;
}

bool Gyroscope::Extend(const double from, const double to, const double angle,
                       const double raw, Segment* const segment) {
  if (!(segment->end > segment->start)) segment->start = from;
  segment->end = to;
  segment->angle += angle;
  segment->turned += std::abs(angle);
  segment->measured += raw;
  return segment->turned >= kSegmentRotation ||
         segment->end - segment->start >= kSegmentSeconds;
}

void Gyroscope::AddMatch(const MatchedRotation& matched) {
  double raw;
  const ScanHeading& heading = matched.heading;
  const double angle = matched.angle + heading.offset - last_heading_;
  last_heading_ = heading.offset;
  if (!Raw(matched.from, matched.to, &raw) || !heading.is_observable ||
      heading.sigma > kMaxSigma || matched.to - matched.from > kMaxInterval) {
    segment_ = Segment();
    last_heading_ = 0.;
    scans_.Restart();
    return;
  }
  offset_.AddMatch(matched.from, matched.to, angle, headings_);
  if (!Extend(matched.from, matched.to, angle, raw, &segment_)) return;
  const double seconds = segment_.end - segment_.start;
  RotationCheck::Stretch stretch;
  stretch.seconds = seconds;
  stretch.measured = segment_.measured;
  stretch.angle = segment_.angle;
  stretch.sigma =
      std::hypot(heading.sigma,
                 kStampNoise / (matched.to - matched.from) * std::abs(angle));
  stretch.walk = heading.sigma *
                 std::sqrt(seconds / std::max(kMinMapAge, heading.map_age));
  scans_.Add(stretch);
  segment_ = Segment();
}

void Gyroscope::AddWheels(const double from, const double to,
                          const double angle) {
  double raw;
  if (!Raw(from, to, &raw) || to - from > kMaxInterval) {
    wheel_segment_ = Segment();
    wheels_.Restart();
    return;
  }
  if (!Extend(from, to, angle, raw, &wheel_segment_)) return;
  const double rate = std::abs(angle) / (to - from);
  RotationCheck::Stretch stretch;
  stretch.seconds = wheel_segment_.end - wheel_segment_.start;
  stretch.measured = wheel_segment_.measured;
  stretch.angle = wheel_segment_.angle;
  stretch.sigma = kStampNoise * rate;
  stretch.is_at_rest = wheel_segment_.turned < kRestAngle;
  wheels_.Add(stretch);
  wheel_segment_ = Segment();
}

void Gyroscope::SetBias(const double bias) {
  scans_.SetBias(bias, options_.bias_noise);
}

}  // namespace front_end
}  // namespace cartographer_ext
