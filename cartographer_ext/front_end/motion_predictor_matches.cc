// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the motion predictor learns from matches.
#include <algorithm>
#include <cmath>

#include "cartographer_ext/front_end/motion_predictor.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A shorter interval gives no velocity, because the jitter of stamps by arrival
// time would dominate it; seconds.
constexpr double kMinVelocityInterval = 0.02;
// Odometry predicts over no more than this since the last insertion: metres,
// radians, seconds.
constexpr double kMaxTranslationSinceInsertion = 1.;
constexpr double kMaxRotationSinceInsertion = 1.;
constexpr double kMaxTimeSinceInsertion = 10.;
// A stationary robot's wheels move less between two scans, and its matches
// scatter less: metres, radians.
constexpr double kStationaryWheelMotion = 1e-3;
constexpr double kStationaryMatchTranslation = 0.02;
constexpr double kStationaryMatchRotation = 0.01;
constexpr double kMinSpeed = 0.1;  // m/s, for the age of the map that is seen
// A submap of fewer scans is hardly more than the last scan, whose errors a match
// repeats: no evidence of a bias of the gyroscope.
constexpr int kMinScansInMap = 10;
// Speeds are compared over no longer than this, seconds: the wheels of a robot
// with a slow laser slip within an interval.
constexpr double kSpeedInterval = 0.1;
constexpr double kMostParts = 10.;

}  // namespace

bool MotionPredictor::IsStationary(const double time,
                                   const Pose2& match) const {
  OdometryMotion odometry;
  return monitor_.IsTrusted() && !IsOdometryDead() &&
         IntegrateOdometry(last_time_, time, &odometry) && !odometry.is_late &&
         odometry.motion.translation().norm() < kStationaryWheelMotion &&
         std::abs(odometry.motion.theta) < kStationaryWheelMotion &&
         std::hypot(match.x, match.y) < kStationaryMatchTranslation &&
         std::abs(match.theta) < kStationaryMatchRotation;
}

void MotionPredictor::SetFieldOfView(const double angle) {
  odometry_noise_.SetFieldOfView(angle);
}

void MotionPredictor::AddInnovation(const MatchInnovation& innovation) {
  odometry_noise_.Add(innovation);
}

OdometryState MotionPredictor::AddMatch(const double time,
                                        const MatchedMotion& matched) {
  const double interval = time - last_time_;
  if (!has_match_) {
    has_match_ = has_anchor_ = true;
    last_time_ = anchor_time_ = insertion_time_ = compared_time_ = time;
    return monitor_.state();
  }
  if (!(interval > 0.)) return monitor_.state();

  const OdometryState state = CheckOdometry(time, matched);
  if (IsWrong(state)) odometry_noise_.AddFault();
  if (state == OdometryState::kOk && matched.rotation_observable) {
    odometry_.AddMatch(last_time_, time, matched.motion);
  }
  if (state == OdometryState::kOk && interval >= kMinVelocityInterval) {
    const Pose2& motion = matched.motion;
    fastest_ = std::max(fastest_, std::hypot(motion.x, motion.y) / interval);
    fastest_turn_ = std::max(fastest_turn_, std::abs(motion.theta) / interval);
  }
  ImuMotion imu;
  const double speed_change =
      IntegrateImu(last_time_, time, &imu) ? SpeedChange(interval, imu) : 0.;
  imu_.AddMatch(
      last_time_, time,
      IsStationary(time, matched.motion) ? Pose2() : matched.motion,
      {matched.rotation_observable && matched.scans_in_map >= kMinScansInMap,
       matched.scan_heading, matched.scan_heading_sigma,
       0.5 * matched.mean_range /
           std::max(kMinSpeed, std::hypot(velocity().x, velocity().y))});
  UpdateVelocity(time, matched, speed_change);
  last_time_ = time;
  UpdateInsertion(time, matched, state);
  return state;
}

OdometryState MotionPredictor::CheckOdometry(const double time,
                                             const MatchedMotion& matched) {
  since_anchor_ = since_anchor_ * matched.motion;
  OdometryMotion odometry;
  const bool has_odometry = odometry_.Predict(last_time_, time, &odometry);
  if (has_odometry && odometry.is_late) {
    // The readings are complete up to the scan before.
    const OdometryState state =
        Compare(last_time_, has_odometry, matched.evidence);
    uncompared_ = matched;
    uncompared_.evidence = nullptr;
    return state;
  }
  if (has_odometry) {
    has_anchor_ = true;
    anchor_time_ = time;
    since_anchor_ = Pose2();
  }
  uncompared_.motion = uncompared_.motion * matched.motion;
  uncompared_.translation_observable =
      uncompared_.translation_observable && matched.translation_observable;
  uncompared_.rotation_observable =
      uncompared_.rotation_observable && matched.rotation_observable;
  uncompared_.covariance = matched.covariance;
  uncompared_.ends_contest = matched.ends_contest;
  return Compare(time, has_odometry, matched.evidence);
}

OdometryState MotionPredictor::Compare(
    const double time, const bool has_odometry,
    const std::function<double(const Pose2&)>& evidence) {
  MotionComparison comparison;
  comparison.evidence = evidence;
  comparison.time = time;
  comparison.interval = time - compared_time_;
  if (!(comparison.interval > 0.)) return monitor_.state();
  OdometryMotion odometry;
  comparison.has_odometry =
      has_odometry && PredictByWheels(compared_time_, time, &odometry);
  comparison.odometry = odometry.motion;
  comparison.frozen = odometry.frozen;
  comparison.makes_up = uncompared_.ends_contest;
  comparison.match = uncompared_.motion;
  comparison.translation_observable = uncompared_.translation_observable;
  comparison.speeds = SpeedsBetween(compared_time_, time);
  const OdometryState state = monitor_.Add(comparison);
  was_stale_ = was_stale_ || state == OdometryState::kStale;

  CalibrationInterval interval;
  interval.time = time;
  interval.interval = comparison.interval;
  interval.odometry = odometry.raw;
  interval.match = uncompared_.motion;
  interval.is_sound = state == OdometryState::kOk && odometry_.has_moved();
  interval.translation_observable = uncompared_.translation_observable;
  interval.rotation_observable = uncompared_.rotation_observable;
  interval.covariance = uncompared_.covariance;
  odometry_.Calibrate(interval);

  compared_time_ = time;
  uncompared_ = MatchedMotion();
  return state;
}

std::vector<WheelSpeed> MotionPredictor::SpeedsBetween(const double from,
                                                       const double to) const {
  const double interval = to - from;
  const int parts =
      std::max(1, static_cast<int>(std::min(
                      kMostParts, std::ceil(interval / kSpeedInterval - 0.5))));
  std::vector<WheelSpeed> speeds;
  for (int i = 0; i < parts; ++i) {
    WheelSpeed speed;
    speed.interval = interval / parts;
    const double start = from + i * speed.interval;
    OdometryMotion odometry;
    if (!odometry_.Predict(start, start + speed.interval, &odometry)) return {};
    speed.speed = odometry.motion.x / speed.interval;
    ImuMotion imu;
    if (imu_.acceleration_is_known() &&
        IntegrateImu(start, start + speed.interval, &imu)) {
      speed.inertial_change = imu.speed_change;
    }
    speeds.push_back(speed);
  }
  return speeds;
}

void MotionPredictor::UpdateVelocity(const double time,
                                     const MatchedMotion& matched,
                                     const double speed_change) {
  const double interval = time - last_time_;
  if (matched.from_velocity &&
      interval <= options_.constant_velocity.max_time) {
    Pose2 motion = matched.motion;
    motion.x -= 0.5 * interval * speed_change;
    velocity_.AddMatch(interval, motion, matched.covariance);
    velocity_.Accelerate(speed_change);
  } else if (interval >= kMinVelocityInterval) {
    Pose2 motion = matched.ends_contest ? matched.rival_motion : matched.motion;
    if (monitor_.suspects_slip() &&
        monitor_.state() == OdometryState::kSlipping) {
      // The match has followed wheels that slip.
      motion.x = monitor_.speed_before_slip() * interval;
    }
    velocity_.Restart(interval, motion);
  }
}

void MotionPredictor::UpdateInsertion(const double time,
                                      const MatchedMotion& matched,
                                      const OdometryState state) {
  since_insertion_ = since_insertion_ * matched.motion;
  const bool is_far =
      since_insertion_.translation().norm() > kMaxTranslationSinceInsertion ||
      std::abs(since_insertion_.theta) > kMaxRotationSinceInsertion ||
      time - insertion_time_ > kMaxTimeSinceInsertion;
  const bool is_faulty =
      state != OdometryState::kOk && state != OdometryState::kSlipSuspected;
  if (is_far || is_faulty || matched.overrules_odometry) AddInsertion();
}

void MotionPredictor::AddInsertion() {
  insertion_time_ = last_time_;
  since_insertion_ = Pose2();
}

}  // namespace front_end
}  // namespace cartographer_ext
