// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dead_reckoning.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// An IMU that is behind by more than this will not come, seconds.
constexpr double kPatience = 2.;

// The step along the arc whose angle is that of the gyroscope.
Pose2 Turned(const Pose2& step, const double angle) {
  Pose2 turned = Pose2(0., 0., 0.5 * NormalizeAngle(angle - step.theta)) * step;
  turned.theta = NormalizeAngle(angle);
  return turned;
}

}  // namespace

DeadReckoning::DeadReckoning(const OdometryNoiseOptions& noise)
    : noise_(noise) {}

void DeadReckoning::Add(const double time, const Pose2& pose) {
  pending_.push_back({time, pose});
}

void DeadReckoning::Advance(const OdometryPredictor& odometry,
                            Gyroscope* const gyroscope) {
  const double offset = odometry.time_offset();
  while (!pending_.empty()) {
    const Reading next = pending_.front();
    if (has_last_ && gyroscope->has_readings()) {
      Step step;
      step.start = last_.time;
      step.end = next.time;
      step.motion = Between(last_.pose, next.pose);
      const double from = step.start + offset;
      const double to = step.end + offset;
      step.is_covered = gyroscope->Raw(from, to, &step.turned);
      if (!step.is_covered && pending_.back().time - next.time < kPatience) {
        return;
      }
      if (step.is_covered) {
        const Pose2 wheels = odometry.calibration().Correct(step.motion);
        gyroscope->AddWheels(from, to, wheels.theta);
      }
      steps_.push_back(step);
      if (steps_.size() > kMaxOdometryReadings) steps_.pop_front();
    }
    has_last_ = true;
    last_ = next;
    pending_.pop_front();
  }
}

bool DeadReckoning::Predict(const double from, const double to,
                            const OdometryPredictor& odometry,
                            const Gyroscope& gyroscope,
                            OdometryMotion* const motion) const {
  const double start = from - odometry.time_offset();
  const double end = to - odometry.time_offset();
  if (gyroscope.state() != GyroscopeState::kProven || steps_.empty() ||
      steps_.front().start > start || steps_.back().end <= start ||
      end - steps_.back().end > noise_.max_extrapolation) {
    return false;
  }
  Pose2 sum;
  const GyroscopeCorrection correction = gyroscope.Correction();
  const auto first = std::upper_bound(
      steps_.begin(), steps_.end(), start,
      [](const double time, const Step& step) { return time < step.end; });
  for (auto step = first; step != steps_.end() && step->start < end; ++step) {
    if (!step->is_covered) return false;
    const double seconds = step->end - step->start;
    const double part =
        (std::min(end, step->end) - std::max(start, step->start)) / seconds;
    const Pose2 wheels = odometry.calibration().Correct(
        Interpolate(Pose2(), step->motion, part));
    sum = sum *
          Turned(wheels, correction.Angle(part * step->turned, part * seconds));
  }
  OdometryMotion rest;
  if (end > steps_.back().end) {
    if (!odometry.Predict(to - (end - steps_.back().end), to, &rest)) {
      return false;
    }
    sum = sum * rest.motion;
  }
  motion->motion = sum;
  motion->covariance =
      TravelCovariance(noise_, sum, correction.Variance(sum.theta, to - from));
  motion->covariance.topLeftCorner<2, 2>() +=
      Squared(odometry.calibration().translation_scale_sigma()) *
      sum.translation().squaredNorm() * Eigen::Matrix2d::Identity();
  return true;
}

}  // namespace front_end
}  // namespace cartographer_ext
