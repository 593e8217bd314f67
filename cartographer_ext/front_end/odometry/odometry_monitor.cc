// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cartographer_ext {
namespace front_end {
namespace {

// A robot with smaller motions is stationary.
constexpr double kStationaryDistance = 0.03;  // metres
constexpr double kStationaryAngle = 0.035;    // radians
// The effect of jitter of the stamps on a steady motion, metres.
constexpr double kStampJitterDistance = 0.06;
// A fault ends below this fraction of the gate (hysteresis).
constexpr double kExitRatio = 0.4;
// It goes on while scans are this much evidence of it: it is as likely as not,
// but where scans say nothing, odometry is all there is.
constexpr double kEvidenceInFault = 1.;
// Bound of the window at any rate of scans.
constexpr size_t kMaxEntries = 200;

double Distance(const Pose2& pose) { return std::hypot(pose.x, pose.y); }

bool IsMotion(const Pose2& motion) {
  return Distance(motion) > kStationaryDistance ||
         std::abs(motion.theta) > kStationaryAngle;
}

// The robot moved, and odometry reported less than half of it.
bool MissesMotion(const Pose2& odometry, const Pose2& motion) {
  return IsMotion(motion) && Distance(odometry) <= 0.5 * Distance(motion) &&
         std::abs(odometry.theta) <=
             0.5 * std::max(std::abs(motion.theta), kStationaryAngle);
}

}  // namespace

bool IsWrong(const OdometryState state) {
  return state == OdometryState::kJumping ||
         state == OdometryState::kSlipping ||
         state == OdometryState::kWrongSign;
}

OdometryMonitor::OdometryMonitor(const OdometryCheckOptions& options)
    : options_(options), suspicion_(options.max_acceleration) {
  Restart(0.);
}

void OdometryMonitor::Restart(const double time) {
  window_.clear();
  window_.push_back({time, Pose2(), Pose2()});
  last_agreed_ = window_.back();
}

double OdometryMonitor::ChiSquare(const Pose2& odometry,
                                  const Pose2& match) const {
  const double distance = std::max(Distance(odometry), Distance(match));
  const double angle =
      std::max(std::abs(odometry.theta), std::abs(match.theta));
  const double rotation_sigma = std::hypot(
      options_.rotation_noise, options_.rotation_noise_per_radian * angle);
  const double translation_sigma =
      std::hypot(std::hypot(options_.translation_noise,
                            options_.translation_noise_per_metre * distance),
                 0.5 * distance * rotation_sigma);
  const double dt = std::hypot(match.x - odometry.x, match.y - odometry.y);
  const double dr = NormalizeAngle(match.theta - odometry.theta);
  return dt * dt / (translation_sigma * translation_sigma) +
         dr * dr / (rotation_sigma * rotation_sigma);
}

bool OdometryMonitor::IsSuspect(const double interval, const Pose2& odometry,
                                const bool frozen,
                                const Pose2& expected) const {
  if (!options_.enabled) return false;
  if (frozen && MissesMotion(odometry, expected)) return true;
  const double allowed = std::min(
      options_.jump_distance,
      kStampJitterDistance + options_.max_acceleration * interval * interval);
  return std::hypot(odometry.x - expected.x, odometry.y - expected.y) >
             allowed ||
         std::abs(NormalizeAngle(odometry.theta - expected.theta)) >
             options_.jump_angle;
}

OdometryState OdometryMonitor::CheckInterval(
    const MotionComparison& comparison) const {
  if (ChiSquare(comparison.odometry, comparison.match) <= options_.gate) {
    // Between two scans, a missing motion may be too small to fail the gate.
    const bool is_stale = comparison.frozen && !IsMotion(comparison.odometry) &&
                          IsMotion(comparison.match);
    return is_stale ? OdometryState::kStale : OdometryState::kOk;
  }
  if (comparison.frozen &&
      MissesMotion(comparison.odometry, comparison.match)) {
    return OdometryState::kStale;
  }
  const double distance =
      std::hypot(comparison.match.x - comparison.odometry.x,
                 comparison.match.y - comparison.odometry.y);
  const double angle = std::abs(
      NormalizeAngle(comparison.match.theta - comparison.odometry.theta));
  if (!comparison.makes_up &&
      (distance > options_.jump_distance || angle > options_.jump_angle) &&
      IsEvident(comparison, comparison.odometry, comparison.match,
                options_.min_evidence)) {
    return OdometryState::kJumping;
  }
  // Smaller differences are decided by the window.
  return OdometryState::kOk;
}

bool OdometryMonitor::IsEvident(const MotionComparison& comparison,
                                const Pose2& odometry, const Pose2& match,
                                const double min_evidence) {
  return !comparison.evidence ||
         comparison.evidence(Between(match, odometry)) >= min_evidence;
}

OdometryState OdometryMonitor::CheckWindow(
    const MotionComparison& comparison) const {
  const Pose2 odometry =
      Between(window_.front().odometry, window_.back().odometry);
  const Pose2 match = Between(window_.front().match, window_.back().match);
  const bool in_fault = state_ == OdometryState::kWrongSign ||
                        state_ == OdometryState::kSlipping ||
                        suspicion_.is_likely();
  const double gate = in_fault ? kExitRatio * options_.gate : options_.gate;
  if (ChiSquare(odometry, match) <= gate ||
      !IsEvident(comparison, odometry, match,
                 in_fault ? kEvidenceInFault : options_.min_evidence)) {
    return OdometryState::kOk;
  }
  const double sum = std::abs(odometry.x + match.x);
  const double larger = std::max(std::abs(odometry.x), std::abs(match.x));
  if (odometry.x * match.x < 0. && larger > 2. * kStationaryDistance &&
      sum < 0.4 * larger) {
    return OdometryState::kWrongSign;
  }
  return OdometryState::kSlipping;
}

OdometryState OdometryMonitor::Add(const MotionComparison& given) {
  const bool was_trusted = IsTrusted();
  const OdometryState state = Judge(given);
  if (given.has_odometry) {
    metres_ += given.match.translation().norm();
    num_faults_ +=
        state == OdometryState::kJumping || (was_trusted && IsWrong(state));
  }
  return state;
}

OdometryState OdometryMonitor::Judge(const MotionComparison& given) {
  MotionComparison comparison = given;
  Pose2& match = comparison.match;
  if (!comparison.translation_observable) {
    // The translation of the match is that of the prediction, which is no
    // evidence against odometry.
    match.x = comparison.odometry.x;
    match.y = comparison.odometry.y;
  }
  if (!options_.enabled) {
    state_ =
        comparison.has_odometry ? OdometryState::kOk : OdometryState::kAbsent;
    return state_;
  }
  if (!comparison.has_odometry) {
    Restart(comparison.time);
    suspicion_.Interrupt();
    state_ = OdometryState::kAbsent;
    return state_;
  }
  SuspectSlip(comparison);
  if (suspicion_.is_believed()) {
    Restart(comparison.time);
    state_ = OdometryState::kSlipping;
  } else {
    state_ = Decide(comparison);
    suspicion_.Learn(IsWrong(state_));
  }
  return state_;
}

void OdometryMonitor::SuspectSlip(const MotionComparison& comparison) {
  std::vector<WheelSpeed> speeds = comparison.speeds;
  if (speeds.empty()) {
    speeds.push_back({comparison.interval,
                      comparison.odometry.x / comparison.interval,
                      absl::nullopt});
  }
  suspicion_.Add(speeds,
                 {comparison.time, comparison.match.x / comparison.interval,
                  comparison.translation_observable});
}

OdometryState OdometryMonitor::Decide(const MotionComparison& comparison) {
  Entry entry;
  entry.time = comparison.time;
  entry.odometry = window_.back().odometry * comparison.odometry;
  entry.match = window_.back().match * comparison.match;
  window_.push_back(entry);
  while (window_.size() > 2 &&
         (window_[1].time <= comparison.time - options_.window ||
          window_.size() > kMaxEntries)) {
    window_.pop_front();
  }

  const OdometryState interval = CheckInterval(comparison);
  if (interval == OdometryState::kJumping) {
    // After stale poses odometry catches up. The window restarts in both cases.
    const bool caught_up =
        state_ == OdometryState::kStale &&
        ChiSquare(Between(last_agreed_.odometry, entry.odometry),
                  Between(last_agreed_.match, entry.match)) <= options_.gate;
    jump_ = MissedBy(entry);
    Restart(comparison.time);
    return caught_up ? OdometryState::kStale : OdometryState::kJumping;
  }
  if (interval == OdometryState::kStale) return OdometryState::kStale;
  if (state_ == OdometryState::kStale) {
    // Odometry moves again. The missed motion is either caught up with or lost.
    Restart(comparison.time);
    return OdometryState::kOk;
  }
  const OdometryState state = CheckWindow(comparison);
  if (state != OdometryState::kOk) return state;
  last_agreed_ = entry;
  return suspects_slip() ? OdometryState::kSlipSuspected : OdometryState::kOk;
}

Pose2 OdometryMonitor::MissedMotion() const {
  return state_ == OdometryState::kJumping ? jump_ : MissedBy(window_.back());
}

Pose2 OdometryMonitor::MissedBy(const Entry& entry) const {
  return Between(entry.match, last_agreed_.match) *
         Between(last_agreed_.odometry, entry.odometry);
}

}  // namespace front_end
}  // namespace cartographer_ext
