// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/imu_predictor.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace front_end {
namespace {

// A robot with a matched motion below these rates is stationary, m/s and rad/s.
constexpr double kStationarySpeed = 0.03;
constexpr double kStationaryTurnRate = 0.02;
// No accelerometer measures less all the time, m/s^2.
constexpr double kLeastAcceleration = 1e-6;

bool IsFinite(const PlanarImuReading& reading) {
  return std::isfinite(reading.time) && reading.acceleration.allFinite() &&
         std::isfinite(reading.yaw_rate);
}

bool IsEarlier(const PlanarImuReading& reading, const double time) {
  return reading.time < time;
}

}  // namespace

ImuPredictor::ImuPredictor(const ImuPredictorOptions& options)
    : options_(options),
      gyroscope_(
          {options.noise.yaw_rate_density, options.yaw_rate_bias_noise}) {}

void ImuPredictor::Add(const PlanarImuReading& reading) {
  if (!options_.enabled || !IsFinite(reading)) return;
  if (!readings_.empty() && reading.time <= readings_.back().time) return;
  last_.is_valid = false;
  gyroscope_.Add(reading.time, reading.yaw_rate);
  readings_.push_back(reading);
  has_acceleration_ =
      has_acceleration_ || reading.acceleration.norm() > kLeastAcceleration;
  while (readings_.size() > kMaxImuReadings ||
         readings_.front().time < reading.time - kImuBufferSeconds) {
    readings_.pop_front();
  }
}

absl::optional<PreintegratedImu> ImuPredictor::Preintegrate(
    const double from, const double to) const {
  if (last_.is_valid && last_.from == from && last_.to == to) return last_.imu;
  if (readings_.size() < 2 || readings_.front().time > from ||
      readings_.back().time < to - kMaxImuExtrapolation || !(to > from)) {
    return absl::nullopt;
  }
  const auto after =
      std::lower_bound(readings_.begin(), readings_.end(), from, IsEarlier);
  ImuPreintegrator integrator(options_.noise, bias_);
  PlanarImuReading last;
  if (after == readings_.begin()) {
    last = *after;
  } else if (after == readings_.end()) {
    last = readings_.back();
  } else {
    last = InterpolateReading(*(after - 1), *after, from);
  }
  last.time = from;
  for (auto it = after; it != readings_.end() && it->time < to; ++it) {
    if (it->time <= from) continue;
    integrator.Add(last, *it);
    last = *it;
  }
  const auto end =
      std::lower_bound(readings_.begin(), readings_.end(), to, IsEarlier);
  PlanarImuReading final_reading = readings_.back();
  if (end != readings_.end() && end != readings_.begin()) {
    final_reading = InterpolateReading(*(end - 1), *end, to);
  }
  final_reading.time = to;
  integrator.Add(last, final_reading);
  last_.is_valid = true;
  last_.from = from;
  last_.to = to;
  last_.imu = integrator.result();
  return last_.imu;
}

bool ImuPredictor::Predict(const double from, const double to,
                           const Eigen::Vector2d& velocity,
                           ImuMotion* const motion) const {
  const double offset = gyroscope_.clock_offset();
  const absl::optional<PreintegratedImu> imu =
      Preintegrate(from - offset, to - offset);
  GyroscopeRotation rotation;
  if (!imu.has_value() || !gyroscope_.Rotation(from, to, &rotation)) {
    return false;
  }
  PlanarState state;
  state.velocity = velocity;
  motion->motion = front_end::Predict(state, *imu).pose;
  motion->speed_change = imu->beta.x();
  const double t = imu->duration;
  const double translation_sigma =
      0.5 * options_.acceleration_bias_noise * t * t;
  motion->covariance.setZero();
  motion->covariance.topLeftCorner<2, 2>() =
      imu->covariance.topLeftCorner<2, 2>() +
      translation_sigma * translation_sigma * Eigen::Matrix2d::Identity();
  motion->motion.theta = rotation.angle;
  motion->covariance(2, 2) = rotation.variance;
  return true;
}

void ImuPredictor::AddMatch(const double from, const double to,
                            const Pose2& match, const ScanHeading& heading) {
  const double interval = to - from;
  if (readings_.empty() || !(interval > 0.)) return;
  gyroscope_.AddMatch({from, to, match.theta, heading});
  const bool is_stationary =
      std::hypot(match.x, match.y) <= kStationarySpeed * interval &&
      std::abs(match.theta) <= kStationaryTurnRate * interval;
  if (!is_stationary) {
    is_stationary_ = false;
    return;
  }
  if (!is_stationary_) {
    is_stationary_ = true;
    stationary_since_ = from;
    sum_.setZero();
    num_summed_ = 0;
    newest_sum_.setZero();
    num_newest_ = 0;
  }
  sum_ += newest_sum_;
  num_summed_ += num_newest_;
  newest_sum_.setZero();
  num_newest_ = 0;
  for (auto it = std::lower_bound(readings_.begin(), readings_.end(), from,
                                  IsEarlier);
       it != readings_.end() && it->time < to; ++it) {
    newest_sum_ += Eigen::Vector3d(it->acceleration.x(), it->acceleration.y(),
                                   it->yaw_rate);
    ++num_newest_;
  }
  if (from - stationary_since_ < options_.stationary_time || num_summed_ == 0) {
    return;
  }
  const Eigen::Vector3d mean = sum_ / num_summed_;
  last_.is_valid = false;
  bias_.acceleration = mean.head<2>();
  bias_.yaw_rate = mean.z();
  gyroscope_.SetBias(mean.z());
  bias_is_known_ = true;
}

}  // namespace front_end
}  // namespace cartographer_ext
