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

// Changes of speed below this many standard deviations of the accelerometer's
// bias count as zero, because they would add up to metres per second.
constexpr double kAccelerationGate = 2.;
// Error of the matched speed, relative to the largest change of speed, over a
// gap that the IMU bridges.
constexpr double kRelativeSpeedError = 0.2;
// Over a longer gap it is no explanation that odometry jumped and the robot stood
// still: the last room would be found again in a room that looks alike. Seconds.
constexpr double kLongestStop = 5.;
// Odometry that is faster than the robot ever was by this factor jumped.
constexpr double kFasterThanTheRobot = 1.5;
constexpr double kReckonedInterval = 1.;  // s, by dead reckoning if longer

}  // namespace

MotionPredictor::MotionPredictor(const MotionPredictorOptions& options)
    : options_(options),
      odometry_(options.odometry, options.time_offset, options.calibration),
      imu_(options.imu),
      reckoning_(options.odometry),
      monitor_(options.check),
      odometry_noise_(options.odometry_noise),
      velocity_(options.constant_velocity, options.odometry.translation,
                options.odometry.rotation) {}

void MotionPredictor::AddOdometry(const double time, const Pose2& pose) {
  if (!options_.use_odometry || !odometry_.Add(time, pose)) return;
  reckoning_.Add(time, pose);
  reckoning_.Advance(odometry_, imu_.mutable_gyroscope());
}

void MotionPredictor::AddImu(const PlanarImuReading& reading) {
  imu_.Add(reading);
  reckoning_.Advance(odometry_, imu_.mutable_gyroscope());
}

MotionPrediction MotionPredictor::Predict(const double time) const {
  const double interval = time - last_time_;
  if (!has_match_ || !(interval > 0.)) return MotionPrediction();

  MotionPrediction prediction = PredictByVelocity(interval);
  ImuMotion imu;
  const bool has_imu = IntegrateImu(last_time_, time, &imu);
  if (has_imu) PredictByImu(interval, imu, &prediction);

  if (has_imu && velocity_.may_be_late() &&
      monitor_.state() == OdometryState::kAbsent) {
    prediction.is_uncertain = true;
    prediction.alternatives.push_back(velocity_.MotionAfterLateScan(interval));
  }
  OdometryMotion odometry;
  if (IsOdometryDead()) return prediction;
  if (IntegrateOdometry(last_time_, time, &odometry)) {
    PredictByOdometry(time, odometry, has_imu, &prediction);
    if (!odometry_.has_moved()) {
      prediction.covariance += WideCovariance(interval);
    }
  } else {
    prediction.odometry_pending =
        prediction.source == PredictionSource::kNothing &&
        monitor_.IsTrusted() &&
        IntegrateOdometry(last_time_, last_time_, &odometry);
  }
  return prediction;
}

MotionPrediction MotionPredictor::PredictByVelocity(
    const double interval) const {
  MotionPrediction prediction;
  if (interval <= options_.constant_velocity.max_time) {
    prediction.source = PredictionSource::kConstantVelocity;
    prediction.motion = velocity_.Motion(interval);
    prediction.covariance = velocity_.MotionCovariance(interval);
    return prediction;
  }
  // After this many seconds the last velocity predicts nothing, least of all
  // the rotation.
  prediction.covariance = WideCovariance(interval);
  prediction.is_uncertain = true;
  prediction.search_radius = options_.constant_velocity.speed_noise * interval;
  prediction.search_angle =
      std::min(kPi, 2. * options_.constant_velocity.turn_rate_noise * interval);
  return prediction;
}

void MotionPredictor::PredictByImu(const double interval, const ImuMotion& imu,
                                   MotionPrediction* const prediction) const {
  prediction->source = PredictionSource::kImu;
  prediction->search_radius = prediction->search_angle = 0.;
  const Eigen::Matrix3d at_rest =
      OdometryCovariance(options_.odometry, Pose2());
  prediction->is_uncertain = interval > options_.constant_velocity.max_time;
  if (prediction->is_uncertain) {
    prediction->motion = imu.motion;
    prediction->covariance = imu.covariance + at_rest;
    // The integration starts with the speed of a match.
    const double sigma =
        kRelativeSpeedError * options_.constant_velocity.speed_noise * interval;
    prediction->covariance.diagonal().head<2>().array() += Squared(sigma);
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

void MotionPredictor::PredictByOdometry(
    const double time, const OdometryMotion& odometry, const bool has_imu,
    MotionPrediction* const prediction) const {
  const double interval = time - last_time_;
  const Pose2 without = prediction->motion;
  const bool has_expectation =
      has_imu || interval <= options_.constant_velocity.max_time;
  const bool is_suspect =
      has_expectation && !odometry.is_late &&
      monitor_.IsSuspect(interval, odometry.motion, odometry.frozen, without);
  if (!monitor_.IsTrusted() && monitor_.state() != OdometryState::kAbsent &&
      has_expectation) {
    // Not used until the monitor trusts it again, but searched around.
    prediction->alternatives.push_back(odometry.motion);
    prediction->alternatives.push_back(monitor_.MissedMotion() *
                                       odometry.motion);
    prediction->is_uncertain = prediction->is_uncertain || is_suspect;
    return;
  }
  const Eigen::Matrix3d covariance_without =
      has_imu ? prediction->covariance : WideCovariance(interval);
  prediction->source = PredictionSource::kOdometry;
  prediction->search_radius = prediction->search_angle = 0.;
  OdometryMotion turned = odometry;
  prediction->heading_by_wheels =
      !has_imu && !odometry.by_gyroscope && !odometry.is_late;
  if (has_imu && !odometry.by_gyroscope) {
    FuseRotation(without.theta, prediction->covariance(2, 2), &turned);
  }
  prediction->motion = turned.motion;
  prediction->covariance = OdometryMotionCovariance(turned, interval);
  prediction->is_uncertain = is_suspect;
  prediction->bridges_gap = odometry.is_reckoned && !is_suspect;
  OdometryMotion since_anchor;
  if (monitor_.state() == OdometryState::kAbsent && has_anchor_ &&
      odometry_.Predict(anchor_time_, time, &since_anchor)) {
    // Odometry has returned, and its readings span the gap.
    prediction->is_uncertain = !odometry.is_late;
    prediction->alternatives.push_back(since_anchor_.Inverse() *
                                       since_anchor.motion);
  }
  if (monitor_.state() == OdometryState::kJumping) {
    // Or the scan before was late: measured long before its stamp.
    prediction->is_uncertain = true;
    prediction->alternatives.push_back(monitor_.MissedMotion() *
                                       odometry.motion);
  }
  if (has_expectation || (interval < kLongestStop && HasJump(time))) {
    prediction->alternatives.push_back(without);
  } else if (interval < kLongestStop) {
    prediction->hints.push_back(without);
  }
  if (is_suspect) {
    // Of the rotation nothing is in doubt that the gyroscope has measured.
    const double rotation_variance = prediction->covariance(2, 2);
    prediction->covariance += covariance_without;
    prediction->covariance += Spread(without, odometry.motion);
    if (has_imu) prediction->covariance(2, 2) = rotation_variance;
  } else {
    PredictFromInsertion(time, prediction);
  }
}

void MotionPredictor::PredictFromInsertion(
    const double time, MotionPrediction* const prediction) const {
  OdometryMotion odometry;
  if (!IntegrateOdometry(insertion_time_, time, &odometry)) return;
  ImuMotion imu;
  if (!odometry.by_gyroscope && IntegrateImu(insertion_time_, time, &imu)) {
    FuseRotation(imu.motion.theta, imu.covariance(2, 2), &odometry);
  }
  prediction->motion = since_insertion_.Inverse() * odometry.motion;
  // Rotates it into the frame of the last scan.
  const Eigen::Matrix3d rotation = PlanarRotation(since_insertion_.theta);
  prediction->covariance =
      rotation.transpose() *
      OdometryMotionCovariance(odometry, time - last_time_) * rotation;
}

bool MotionPredictor::IntegrateImu(const double from, const double to,
                                   ImuMotion* const motion) const {
  const GyroscopeState state = imu_.gyroscope().state();
  if (state == GyroscopeState::kRefuted ||
      (state == GyroscopeState::kUnproven && monitor_.IsTrusted())) {
    return false;
  }
  return imu_.Predict(from, to, Eigen::Vector2d(velocity().x, velocity().y),
                      motion);
}

bool MotionPredictor::IntegrateOdometry(const double from, const double to,
                                        OdometryMotion* const motion) const {
  if (!PredictByWheels(from, to, motion)) return false;
  if (!motion->is_reckoned) {
    motion->covariance = odometry_noise_.ScaleHeading(motion->covariance);
  }
  motion->by_gyroscope =
      to - from > kReckonedInterval &&
      reckoning_.Predict(from, to, odometry_, imu_.gyroscope(), motion);
  return true;
}

bool MotionPredictor::PredictByWheels(const double from, const double to,
                                      OdometryMotion* const motion) const {
  if (!odometry_.Predict(from, to, motion)) return false;
  if (to - from > kReckonedInterval) {
    odometry_.Reckon(from, to, monitor_.faults_per_metre(), motion);
  }
  return true;
}

Eigen::Matrix3d MotionPredictor::WideCovariance(const double interval) const {
  const double translation = options_.odometry.translation +
                             options_.constant_velocity.speed_noise * interval;
  const double rotation = options_.odometry.rotation +
                          options_.constant_velocity.turn_rate_noise * interval;
  return Eigen::Vector3d(Squared(translation), Squared(translation),
                         Squared(rotation))
      .asDiagonal();
}

Eigen::Matrix3d MotionPredictor::OdometryMotionCovariance(
    const OdometryMotion& odometry, const double interval) const {
  Eigen::Matrix3d covariance =
      odometry.is_reckoned
          ? odometry.covariance
          : odometry_noise_.ScaleTranslation(odometry.covariance);
  // The end of the interval is extrapolated.
  if (odometry.is_late) covariance += WideCovariance(interval);
  return covariance;
}

double MotionPredictor::SpeedChange(const double interval,
                                    const ImuMotion& imu) const {
  const double least =
      kAccelerationGate * options_.imu.acceleration_bias_noise * interval;
  return imu_.acceleration_is_known() && std::abs(imu.speed_change) > least
             ? imu.speed_change
             : 0.;
}

bool MotionPredictor::HasJump(const double time) const {
  return odometry_.HasJump(
      last_time_, time,
      {options_.check.jump_distance, options_.check.jump_angle,
       kFasterThanTheRobot * fastest_, kFasterThanTheRobot * fastest_turn_});
}

}  // namespace front_end
}  // namespace cartographer_ext
