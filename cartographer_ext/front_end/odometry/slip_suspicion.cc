// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/slip_suspicion.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace front_end {
namespace {

// A suspicion expires after this time, seconds.
constexpr double kSuspicionTime = 5.;
// So long after a sudden change a slip would have been found, seconds: the window
// of the comparison with the matches, and half of that.
constexpr double kDecisionTime = 1.5;
// A slower robot is about to start or to stop, m/s.
constexpr double kDrivingSpeed = 0.1;
// Error of the fastest speed by matches, relative.
constexpr double kFaster = 1.1;
// The motion between two scans by the IMU is known twice as well.
constexpr double kInertialRatio = 0.5;
constexpr double kPriorSlips = 1.;
constexpr double kPriorOthers = 0.5;
// For so many parts, and by so much in metres, a change must last: stamps by time
// of arrival come late and then in a bunch.
constexpr int kMinParts = 2;
constexpr double kJitterDistance = 0.06;
// Over less there is no speed, seconds.
constexpr double kShortestInterval = 0.049;
// Of the slowest lasers, seconds. Between scans that are further apart nothing
// predicts as well as odometry, whatever it did.
constexpr double kLongestInterval = 0.3;
// The wheels grip again when this part of the change is left.
constexpr double kOver = 0.5;
constexpr double kSpeedTime = 0.5;  // over which a speed is averaged, seconds

// The average after another interval with this speed.
double Averaged(const double average, const double speed,
                const double interval) {
  return average - std::expm1(-interval / kSpeedTime) * (speed - average);
}

}  // namespace

bool SlipSuspicion::IsSudden(const WheelSpeed& wheels,
                             const double change) const {
  const double own = change - wheels.inertial_change.value_or(0.);
  const double limit =
      (wheels.inertial_change.has_value() ? kInertialRatio : 1.) *
      max_acceleration_ * wheels.interval;
  return std::abs(own) > limit;
}

double SlipSuspicion::SlipProbability() const {
  return (num_slips_ + kPriorSlips) /
         (num_slips_ + num_others_ + kPriorSlips + kPriorOthers);
}

void SlipSuspicion::AddPart(const WheelSpeed& part) {
  pending_.speed =
      (pending_.speed * pending_.interval + part.speed * part.interval) /
      (pending_.interval + part.interval);
  pending_.interval += part.interval;
  time_ += part.interval;
  if (part.inertial_change.has_value()) {
    pending_.inertial_change =
        pending_.inertial_change.value_or(0.) + *part.inertial_change;
  }
  if (pending_.interval < kShortestInterval) return;
  AddSpeed(pending_);
  pending_ = WheelSpeed();
}

void SlipSuspicion::AddSpeed(const WheelSpeed& wheels) {
  const double before = speed_.value_or(wheels.speed);
  const double change = wheels.speed - before;
  speed_ = wheels.speed;
  const double excess = std::abs(wheels.speed) - std::abs(speed_before_);
  if (IsSudden(wheels, change) && excess > 0.) {
    if (!is_suspicious_) {
      is_suspicious_ = is_told_ = true;
      was_driving_ = std::abs(before) > kDrivingSpeed;
      largest_excess_ = excess_distance_ = 0.;
    }
    suspected_since_ = time_;
    if (was_driving_ && !is_undecided_) {
      is_undecided_ = true;
      told_ = 0.;
    }
  }
  largest_excess_ = std::max(largest_excess_, excess);
  excess_distance_ += excess * wheels.interval;
  if (excess <= kOver * largest_excess_ ||
      time_ - suspected_since_ > kSuspicionTime) {
    num_others_ += is_undecided_ && is_sudden_ && is_told_;
    is_suspicious_ = is_undecided_ = false;
  }
  suspected_parts_ = is_suspicious_ ? suspected_parts_ + 1 : 0;
  if (!is_suspicious_) {
    speed_before_ = Averaged(speed_before_, wheels.speed, wheels.interval);
  }
}

void SlipSuspicion::Add(const std::vector<WheelSpeed>& wheels,
                        const MatchedSpeed& match) {
  last_ = match;
  last_interval_ = 0.;
  for (const WheelSpeed& part : wheels) last_interval_ += part.interval;
  time_ = match.time - last_interval_;
  if (last_interval_ > kLongestInterval) {
    Interrupt();
    return;
  }
  for (const WheelSpeed& part : wheels) AddPart(part);
  is_told_ = is_told_ && match.is_observable;
  is_sudden_ =
      suspected_parts_ >= kMinParts && excess_distance_ > kJitterDistance;
  is_likely_ = is_sudden_ && was_driving_ &&
               std::abs(speed_.value_or(0.)) > kFaster * fastest_ &&
               fastest_ > kDrivingSpeed && SlipProbability() > 0.5;
}

void SlipSuspicion::Learn(const bool is_wrong) {
  if (is_wrong) {
    fastest_now_ = fastest_before_ = period_ = 0.;
    num_slips_ += is_undecided_;
    is_undecided_ = false;
    return;
  }
  if (!last_.is_observable) return;
  matched_speed_ = Averaged(matched_speed_, last_.speed, last_interval_);
  fastest_now_ = std::max(fastest_now_, std::abs(matched_speed_));
  period_ += last_interval_;
  if (period_ >= kDecisionTime) {
    fastest_ = std::max(fastest_, fastest_before_);
    fastest_before_ = fastest_now_;
    fastest_now_ = period_ = 0.;
  }
  if (!is_undecided_) return;
  told_ += last_interval_;
  if (told_ < kDecisionTime) return;
  ++num_others_;
  is_undecided_ = is_suspicious_ = false;
}

void SlipSuspicion::Interrupt() {
  speed_.reset();
  is_suspicious_ = is_sudden_ = is_likely_ = is_undecided_ = false;
  suspected_parts_ = 0;
  pending_ = WheelSpeed();
}

}  // namespace front_end
}  // namespace cartographer_ext
