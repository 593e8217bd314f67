// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/rotation_check.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Before the first turn nothing is known of the factor. A MEMS gyroscope that
// was not calibrated at rest has a bias of some degrees a second.
constexpr double kFactorSigma = 1.;
constexpr double kBiasSigma = 0.05;  // rad/s
// One that was, as most are, has a bias of some tenths of a degree a second.
constexpr double kSoundBiasSigma = 0.005;  // rad/s
constexpr double kSoundShare = 0.9;
// Of what the calibration cannot know: temperature, cross axes.
constexpr double kFactorFloor = 0.002;
constexpr double kBiasFloor = 2e-4;  // rad/s
// The length of a stretch at rest, relative to its time.
constexpr double kRestLength = 0.01;

// A known factor has at most this standard deviation, and a sound one is at most
// this far from one: sensors are calibrated to a few per cent.
constexpr double kKnownFactorSigma = 0.1;
constexpr double kMaxFactorError = 0.25;
// Of the last stretches, of which there are at least this many, at most this
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

void RotationCheck::Add(const Stretch& stretch) {
  const bool bias_counts = !drifts_ || stretch.is_at_rest;
  const bool agrees = filter_.Add(
      Eigen::Vector2d(stretch.measured, bias_counts ? stretch.seconds : 0.),
      (stretch.is_at_rest ? kRestLength : 1.) * stretch.seconds, stretch.angle,
      stretch.sigma, stretch.walk);
  compared_ = kForgetting * compared_ + 1.;
  contradicted_ = kForgetting * contradicted_ + (agrees ? 0. : 1.);
}

void RotationCheck::SetBias(const double bias, const double sigma) {
  filter_.Set(1, -bias * filter_.value(0), sigma);
}

bool RotationCheck::factor_is_known() const {
  return filter_.sigma(0) <= kKnownFactorSigma;
}

RotationCheck::Drift RotationCheck::EstimateDrift() const {
  // What was measured, without the prior of the filter.
  const double prior = Squared(kBiasSigma);
  const double variance = std::min(Squared(filter_.sigma(1)), 0.999 * prior);
  const double measured_variance = 1. / (1. / variance - 1. / prior);
  const double measured = filter_.value(1) * measured_variance / variance;
  // The mixture of both kinds of gyroscopes.
  double weight[2], mean[2], spread[2];
  const double priors[2] = {Squared(kSoundBiasSigma), prior};
  for (int i = 0; i < 2; ++i) {
    const double sum = priors[i] + measured_variance;
    weight[i] = (i == 0 ? kSoundShare : 1. - kSoundShare) *
                std::exp(-0.5 * Squared(measured) / sum) / std::sqrt(sum);
    mean[i] = priors[i] / sum * measured;
    spread[i] = priors[i] / sum * measured_variance;
  }
  const double share = weight[0] / (weight[0] + weight[1]);
  Drift drift;
  drift.value = share * mean[0] + (1. - share) * mean[1];
  drift.variance = share * spread[0] + (1. - share) * spread[1] +
                   share * (1. - share) * Squared(mean[0] - mean[1]);
  return drift;
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
