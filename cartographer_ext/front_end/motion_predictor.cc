// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/motion_predictor.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A velocity needs an interval that a stamp of arrival does not spoil, seconds.
constexpr double kMinVelocityInterval = 0.02;
// Odometry is not asked for a longer way than this since the last scan that is
// in the map: metres, radians, seconds.
constexpr double kMaxWaySinceMap = 1.;
constexpr double kMaxTurnSinceMap = 1.;
constexpr double kMaxTimeSinceMap = 10.;
// Changes of the speed that the bias of the accelerometer may feign are none:
// added up they would soon be metres a second. Standard deviations.
constexpr double kAccelerationGate = 2.;
// Wheels that moved less between two scans stand still; matches of a robot that
// stands are off by less: metres, radians.
constexpr double kStandingWheels = 1e-3;
constexpr double kStandingMatchWay = 0.02;
constexpr double kStandingMatchTurn = 0.01;

// The second moment of being off by all of `difference`.
Eigen::Matrix3d Spread(const Pose2& difference) {
  const Eigen::Vector3d d(difference.x, difference.y, difference.theta);
  return d.cwiseAbs2().asDiagonal();
}

// Two independent readings of the turn.
void WeighTurns(const ImuMotion& imu, OdometryMotion* const odometry) {
  const double a = odometry->covariance(2, 2);
  const double b = imu.covariance(2, 2);
  const double ratio = a / (a + b);
  odometry->motion.theta = NormalizeAngle(
      odometry->motion.theta +
      ratio * NormalizeAngle(imu.motion.theta - odometry->motion.theta));
  odometry->covariance(2, 2) = a * b / (a + b);
}

}  // namespace

MotionPredictor::MotionPredictor(const MotionPredictorOptions& options)
    : options_(options),
      odometry_(options.odometry, options.time_offset, options.calibration),
      imu_(options.imu),
      monitor_(options.check),
      velocity_(options.constant_velocity, options.odometry.translation,
                options.odometry.rotation) {}

void MotionPredictor::AddOdometry(const double time, const Pose2& pose) {
  if (options_.use_odometry) odometry_.Add(time, pose);
}

void MotionPredictor::AddImu(const PlanarImuReading& reading) {
  imu_.Add(reading);
}

Pose2 MotionPredictor::VelocityMotion(const double interval) const {
  // Beyond that nothing is known, least of all a turn.
  if (interval > options_.constant_velocity.max_time) return Pose2();
  return velocity_.Motion(interval);
}

Eigen::Matrix3d MotionPredictor::WideCovariance(const double interval) const {
  const double way = options_.odometry.translation +
                     options_.constant_velocity.speed_noise * interval;
  const double turn = options_.odometry.rotation +
                      options_.constant_velocity.turn_rate_noise * interval;
  return Eigen::Vector3d(Squared(way), Squared(way), Squared(turn))
      .asDiagonal();
}

bool MotionPredictor::PredictOdometry(const double time,
                                      OdometryMotion* const motion) const {
  return options_.use_odometry && odometry_.Predict(last_time_, time, motion);
}

MotionPrediction MotionPredictor::Predict(const double time) const {
  MotionPrediction prediction;
  const double interval = time - last_time_;
  if (!has_match_ || !(interval > 0.)) return prediction;

  prediction.source = interval > options_.constant_velocity.max_time
                          ? PredictionSource::kNothing
                          : PredictionSource::kConstantVelocity;
  prediction.motion = VelocityMotion(interval);
  prediction.covariance =
      prediction.source == PredictionSource::kConstantVelocity
          ? velocity_.MotionCovariance(interval)
          : WideCovariance(interval);
  prediction.is_uncertain = prediction.source == PredictionSource::kNothing;
  if (prediction.is_uncertain) {
    prediction.unknown_way = options_.constant_velocity.speed_noise * interval;
    prediction.unknown_turn = std::min(
        kPi, 2. * options_.constant_velocity.turn_rate_noise * interval);
  }

  ImuMotion imu;
  const bool has_imu = imu_.Predict(
      last_time_, time, Eigen::Vector2d(velocity().x, velocity().y), &imu);
  if (has_imu) {
    PredictInertially(interval, imu, &prediction);
  }

  OdometryMotion odometry;
  if (!PredictOdometry(time, &odometry)) {
    prediction.odometry_is_missing =
        prediction.source == PredictionSource::kNothing &&
        monitor_.IsTrusted() && PredictOdometry(last_time_, &odometry);
    return prediction;
  }
  const Pose2 without = prediction.motion;
  const bool expectation_is_known =
      has_imu || interval <= options_.constant_velocity.max_time;
  const bool is_suspect =
      expectation_is_known && !odometry.is_late &&
      monitor_.IsSuspect(interval, odometry.motion, odometry.frozen, without);
  if (!monitor_.IsTrusted() && monitor_.state() != OdometryState::kAbsent &&
      expectation_is_known) {
    // Out of favour until the monitor says otherwise; still worth a try.
    prediction.alternatives.push_back(odometry.motion);
    prediction.alternatives.push_back(monitor_.BacklogUntilNow() *
                                      odometry.motion);
    prediction.is_uncertain = prediction.is_uncertain || is_suspect;
    return prediction;
  }
  prediction.unknown_way = prediction.unknown_turn = 0.;
  const Eigen::Matrix3d covariance_without =
      has_imu ? prediction.covariance : WideCovariance(interval);
  prediction.source = PredictionSource::kOdometry;
  prediction.motion = odometry.motion;
  prediction.covariance = CovarianceOf(odometry, interval);
  prediction.is_uncertain = is_suspect;
  OdometryMotion since_anchor;
  if (monitor_.state() == OdometryState::kAbsent && has_anchor_ &&
      odometry_.Predict(anchor_time_, time, &since_anchor)) {
    // Odometry is back: it knows what happened in between, too.
    prediction.is_uncertain = !odometry.is_late;
    prediction.alternatives.push_back(since_anchor_.Inverse() *
                                      since_anchor.motion);
  }
  if (is_suspect) {
    prediction.alternatives.push_back(without);
    prediction.covariance += covariance_without;
    prediction.covariance += Spread(
        Pose2(odometry.motion.x - without.x, odometry.motion.y - without.y,
              NormalizeAngle(odometry.motion.theta - without.theta)));
  } else {
    prediction.alternatives.push_back(without);
    PredictFromMap(time, &prediction);
  }
  return prediction;
}

double MotionPredictor::SpeedChange(const double interval,
                                    const ImuMotion& imu) const {
  const double least =
      kAccelerationGate * options_.imu.acceleration_bias_noise * interval;
  return imu_.bias_is_known() && std::abs(imu.speed_change) > least
             ? imu.speed_change
             : 0.;
}

void MotionPredictor::PredictInertially(
    const double interval, const ImuMotion& imu,
    MotionPrediction* const prediction) const {
  prediction->source = PredictionSource::kImu;
  prediction->unknown_way = prediction->unknown_turn = 0.;
  const Eigen::Matrix3d at_rest =
      OdometryCovariance(options_.odometry, Pose2());
  prediction->is_uncertain = interval > options_.constant_velocity.max_time;
  if (prediction->is_uncertain) {
    prediction->motion = imu.motion;
    prediction->covariance = imu.covariance + at_rest;
    // The speed at the start is that of a match.
    const double way = 0.2 * options_.constant_velocity.speed_noise * interval;
    prediction->covariance(0, 0) += Squared(way);
    prediction->covariance(1, 1) += Squared(way);
    return;
  }
  prediction->motion = velocity_.Motion(interval);
  prediction->motion.x += 0.5 * interval * SpeedChange(interval, imu);
  prediction->motion.theta = imu.motion.theta;
  prediction->covariance.setZero();
  prediction->covariance.topLeftCorner<2, 2>() =
      velocity_.MotionCovariance(interval).topLeftCorner<2, 2>();
  prediction->covariance(2, 2) = imu.covariance(2, 2) + at_rest(2, 2);
}

Eigen::Matrix3d MotionPredictor::CovarianceOf(const OdometryMotion& odometry,
                                              const double interval) const {
  Eigen::Matrix3d covariance = odometry.covariance;
  // Its end is a guess from the readings before.
  if (odometry.is_late) covariance += WideCovariance(interval);
  return covariance;
}

void MotionPredictor::PredictFromMap(const double time,
                                     MotionPrediction* const prediction) const {
  OdometryMotion odometry;
  if (!odometry_.Predict(map_time_, time, &odometry)) return;
  ImuMotion imu;
  if (imu_.Predict(map_time_, time, Eigen::Vector2d::Zero(), &imu)) {
    WeighTurns(imu, &odometry);
  }
  prediction->motion = since_map_.Inverse() * odometry.motion;
  // Into the frame of the last scan.
  const Eigen::Matrix3d rotation = PlanarRotation(since_map_.theta);
  prediction->covariance = rotation.transpose() *
                           CovarianceOf(odometry, time - last_time_) * rotation;
}

void MotionPredictor::AddToMap() {
  map_time_ = last_time_;
  since_map_ = Pose2();
}

bool MotionPredictor::Stands(const double time, const Pose2& match) const {
  OdometryMotion odometry;
  return monitor_.IsTrusted() && PredictOdometry(time, &odometry) &&
         !odometry.is_late &&
         std::hypot(odometry.motion.x, odometry.motion.y) < kStandingWheels &&
         std::abs(odometry.motion.theta) < kStandingWheels &&
         std::hypot(match.x, match.y) < kStandingMatchWay &&
         std::abs(match.theta) < kStandingMatchTurn;
}

OdometryState MotionPredictor::CheckOdometry(const double time,
                                             const MatchedMotion& matched) {
  since_anchor_ = since_anchor_ * matched.motion;
  OdometryMotion odometry;
  const bool has_odometry = PredictOdometry(time, &odometry);
  if (has_odometry && odometry.is_late) {
    // Up to the scan before everything is there.
    const OdometryState state = Compare(last_time_, has_odometry);
    not_compared_ = matched;
    return state;
  }
  if (has_odometry) {
    has_anchor_ = true;
    anchor_time_ = time;
    since_anchor_ = Pose2();
  }
  not_compared_.motion = not_compared_.motion * matched.motion;
  not_compared_.way_is_determined =
      not_compared_.way_is_determined && matched.way_is_determined;
  not_compared_.turn_is_determined =
      not_compared_.turn_is_determined && matched.turn_is_determined;
  not_compared_.covariance = matched.covariance;
  return Compare(time, has_odometry);
}

OdometryState MotionPredictor::Compare(const double time,
                                       const bool has_odometry) {
  MotionComparison comparison;
  comparison.time = time;
  comparison.interval = time - compared_time_;
  if (!(comparison.interval > 0.)) return monitor_.state();
  OdometryMotion odometry;
  comparison.has_odometry =
      has_odometry && odometry_.Predict(compared_time_, time, &odometry);
  comparison.odometry = odometry.motion;
  comparison.frozen = odometry.frozen;
  comparison.match = not_compared_.motion;
  comparison.way_is_determined = not_compared_.way_is_determined;
  ImuMotion imu;
  if (imu_.Predict(compared_time_, time,
                   Eigen::Vector2d(velocity().x, velocity().y), &imu)) {
    comparison.has_inertial = imu_.bias_is_known();
    comparison.inertial_speed_change = imu.speed_change;
  }
  const OdometryState state = monitor_.Add(comparison);

  CalibrationInterval interval;
  interval.time = time;
  interval.interval = comparison.interval;
  interval.odometry = odometry.raw;
  interval.match = not_compared_.motion;
  interval.is_sound = state == OdometryState::kOk;
  interval.way_is_determined = not_compared_.way_is_determined;
  interval.turn_is_determined = not_compared_.turn_is_determined;
  interval.covariance = not_compared_.covariance;
  odometry_.Calibrate(interval);

  compared_time_ = time;
  not_compared_ = MatchedMotion();
  return state;
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
    velocity_.Restart(interval, matched.motion);
  }
}

OdometryState MotionPredictor::AddMatch(const double time,
                                        const MatchedMotion& matched) {
  const double interval = time - last_time_;
  if (!has_match_) {
    has_match_ = true;
    last_time_ = time;
    has_anchor_ = true;
    anchor_time_ = time;
    map_time_ = time;
    compared_time_ = time;
    return monitor_.state();
  }
  if (!(interval > 0.)) return monitor_.state();

  const OdometryState state = CheckOdometry(time, matched);
  if (state == OdometryState::kOk && matched.turn_is_determined) {
    odometry_.AddMatch(last_time_, time, matched.motion);
  }
  ImuMotion imu;
  const double speed_change =
      imu_.Predict(last_time_, time, Eigen::Vector2d::Zero(), &imu)
          ? SpeedChange(interval, imu)
          : 0.;
  imu_.AddMatch(last_time_, time,
                Stands(time, matched.motion) ? Pose2() : matched.motion);

  UpdateVelocity(time, matched, speed_change);
  last_time_ = time;
  since_map_ = since_map_ * matched.motion;
  const bool is_far =
      std::hypot(since_map_.x, since_map_.y) > kMaxWaySinceMap ||
      std::abs(since_map_.theta) > kMaxTurnSinceMap ||
      time - map_time_ > kMaxTimeSinceMap;
  if (is_far || !(state == OdometryState::kOk ||
                  state == OdometryState::kSlipSuspected)) {
    AddToMap();
  }
  return state;
}

}  // namespace front_end
}  // namespace cartographer_ext
