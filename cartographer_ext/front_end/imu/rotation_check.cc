// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/rotation_check.h"

#include <cmath>

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
// The length of a stretch at rest, relative to its time.
constexpr double kRestLength = 0.01;

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

RotationCheck::RotationCheck(const CalibrationFilter::Noise& noise,
                             const bool drifts)
    : drifts_(drifts),
      filter_(Eigen::Vector2d(1., 0.),
              Eigen::Vector2d(kFactorSigma, kBiasSigma),
              Eigen::Vector2d(kFactorFloor, kBiasFloor), noise) {}

void RotationCheck::Add(const double seconds, const double measured,
                        const double angle, const double sigma,
                        const bool is_at_rest) {
  const bool agrees = filter_.Add(
      Eigen::Vector2d(measured, drifts_ && !is_at_rest ? 0. : seconds),
      (is_at_rest ? kRestLength : 1.) * seconds, angle, sigma);
  compared_ = kForgetting * compared_ + 1.;
  contradicted_ = kForgetting * contradicted_ + (agrees ? 0. : 1.);
}

void RotationCheck::SetBias(const double bias, const double sigma) {
  filter_.Set(1, -bias * filter_.value(0), sigma);
}

bool RotationCheck::factor_is_known() const {
  return filter_.sigma(0) <= kKnownFactorSigma;
}

GyroscopeState RotationCheck::state() const {
  if (compared_ >= kMinCompared &&
      contradicted_ > kMaxContradicted * compared_) {
    return GyroscopeState::kRefuted;
  }
  if (!factor_is_known()) return GyroscopeState::kUnproven;
  return std::abs(filter_.value(0) - 1.) <= kMaxFactorError
             ? GyroscopeState::kProven
             : GyroscopeState::kRefuted;
}

}  // namespace front_end
}  // namespace cartographer_ext
