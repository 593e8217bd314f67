// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry_calibration.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Matches of scans that tell the whole pose err by some millimetres from one to
// the next, and by 6 to 8 mm per root metre from map to map (simulated offices
// and corridors against the truth).
constexpr CalibrationFilter::Noise kWayNoise = {0.01, 0.008, 3e-5, 4.};
// And by 0.1 degrees. What goes with the way is the wheels here: 4 mm per root
// metre of each and 40 cm apart are 0.8 degrees.
constexpr CalibrationFilter::Noise kTurnNoise = {0.002, 0.015, 3e-5, 4.};
// So many metres wheels go while the robot turns on the spot by a radian.
constexpr double kWheelRadius = 0.2;
// Of the scale of whole maps, and of what else is common to all matches.
constexpr double kWayFloor = 0.001;
constexpr double kTurnFloor = 0.002;
constexpr double kTurnPerMetreFloor = 0.0002;
// Stamps of scans against those of odometry, seconds.
constexpr double kStampNoise = 0.02;

// A stretch ends after this way, in metres, or turn, in radians.
constexpr double kStretchWay = 0.5;
constexpr double kStretchTurn = 0.5;
// Scans further apart, in seconds, are a gap.
constexpr double kMaxInterval = 1.;
// A scan tells the way if its match is this certain, metres, radians.
constexpr double kMaxWaySigma = 0.012;
constexpr double kMaxTurnSigma = 0.006;
// What is seen of odometry may have begun this long ago, seconds.
constexpr double kSettleTime = 3.;
constexpr size_t kMaxPending = 100;

double Clamped(const double value, const double initial, const double most) {
  return std::min(initial + most, std::max(initial - most, value));
}

// Direction of a motion on an arc, in the frame of its start.
Eigen::Vector2d Forward(const Pose2& motion) {
  return Eigen::Vector2d(std::cos(0.5 * motion.theta),
                         std::sin(0.5 * motion.theta));
}

// Signed.
double Way(const Pose2& motion) {
  return motion.translation().dot(Forward(motion));
}

}  // namespace

CalibrationFilter::CalibrationFilter(const Eigen::Vector2d& values,
                                     const Eigen::Vector2d& sigmas,
                                     const Eigen::Vector2d& floors,
                                     const Noise& noise)
    : initial_variances_(sigmas.cwiseAbs2()),
      floors_(floors),
      noise_(noise),
      state_(values.x(), values.y(), 0.),
      covariance_(Eigen::Matrix3d::Zero()) {
  covariance_.diagonal().head<2>() = initial_variances_;
  Restart();
}

void CalibrationFilter::Restart() {
  state_.z() = 0.;
  covariance_.row(2).setZero();
  covariance_.col(2).setZero();
  covariance_(2, 2) = Squared(noise_.match);
}

double CalibrationFilter::sigma(const int i) const {
  return std::sqrt(
      std::min(initial_variances_(i), covariance_(i, i) + Squared(floors_(i))));
}

bool CalibrationFilter::Add(const Eigen::Vector2d& regressors,
                            const double length, const double matched,
                            const double extra) {
  Eigen::Matrix3d transition = Eigen::Matrix3d::Identity();
  transition.row(2).head<2>() = regressors.transpose();
  state_ = transition * state_;
  covariance_ = transition * covariance_ * transition.transpose();
  covariance_(2, 2) += Squared(noise_.walk) * length;
  for (int i = 0; i < 2; ++i) {
    // Never less certain than at the beginning.
    covariance_(i, i) +=
        std::min(Squared(noise_.wander) * length,
                 std::max(0., initial_variances_(i) - covariance_(i, i)));
  }

  const double measurement = Squared(noise_.match) + Squared(extra);
  const double variance = covariance_(2, 2) + measurement;
  const double residual = matched - state_.z();
  if (!(Squared(residual) <= Squared(noise_.max_residual) * variance)) {
    Restart();
    return false;
  }
  const Eigen::Vector3d gain = covariance_.col(2) / variance;
  state_ += gain * residual;
  // Joseph's form stays positive semi-definite.
  Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
  rest.col(2) -= gain;
  covariance_ = Symmetric(rest * covariance_ * rest.transpose() +
                          measurement * gain * gain.transpose());
  state_.z() -= matched;
  return true;
}

OdometryCalibration::OdometryCalibration(
    const OdometryCalibrationOptions& options)
    : options_(options),
      way_(Eigen::Vector2d(options.way_scale, 0.),
           Eigen::Vector2d(options.estimate_way ? options.way_sigma : 0., 0.),
           Eigen::Vector2d(kWayFloor, 0.), kWayNoise),
      turn_(Eigen::Vector2d(options.turn_scale, options.turn_per_metre),
            options.estimate_turn
                ? Eigen::Vector2d(options.turn_sigma,
                                  options.turn_per_metre_sigma)
                : Eigen::Vector2d(0., 0.),
            Eigen::Vector2d(kTurnFloor, kTurnPerMetreFloor), kTurnNoise) {}

void OdometryCalibration::Discard(const double time) {
  current_ = Stretch();
  pending_.clear();
  is_broken_ = true;
  has_fault_ = true;
  fault_time_ = time;
}

void OdometryCalibration::Add(const CalibrationInterval& interval) {
  if (!options_.estimate_way && !options_.estimate_turn) return;
  if (!interval.is_sound || !(interval.interval > 0.) ||
      interval.interval > kMaxInterval) {
    Discard(interval.time);
    return;
  }
  if (has_fault_ && interval.time - fault_time_ < kSettleTime) return;
  has_fault_ = false;

  const double way = Way(interval.odometry);
  const double turn = interval.odometry.theta;
  current_.time = interval.time;
  current_.odometry_way += way;
  current_.odometry_turn += turn;
  current_.matched_way += Way(interval.match);
  current_.matched_turn += interval.match.theta;
  current_.length += std::abs(way);
  current_.rotation += std::abs(turn);
  const Eigen::Vector2d forward = Forward(interval.match);
  const double way_sigma = std::sqrt(std::max(
      0., forward.dot(interval.covariance.topLeftCorner<2, 2>() * forward)));
  const double turn_sigma = std::sqrt(std::max(0., interval.covariance(2, 2)));
  current_.way_is_determined = current_.way_is_determined &&
                               interval.way_is_determined &&
                               way_sigma <= kMaxWaySigma;
  current_.turn_is_determined = current_.turn_is_determined &&
                                interval.turn_is_determined &&
                                turn_sigma <= kMaxTurnSigma;
  const double stamp = kStampNoise / interval.interval;
  current_.way_sigma = std::hypot(way_sigma, stamp * way);
  current_.turn_sigma = std::hypot(turn_sigma, stamp * turn);
  if (current_.length < kStretchWay && current_.rotation < kStretchTurn) {
    return;
  }
  pending_.push_back(current_);
  current_ = Stretch();
  while (!pending_.empty() &&
         (interval.time - pending_.front().time >= kSettleTime ||
          pending_.size() > kMaxPending)) {
    Learn(pending_.front());
    pending_.pop_front();
  }
}

void OdometryCalibration::Learn(const Stretch& stretch) {
  if (is_broken_) {
    way_.Restart();
    turn_.Restart();
    is_broken_ = false;
  }
  if (stretch.way_is_determined) {
    way_.Add(Eigen::Vector2d(stretch.odometry_way, 0.), stretch.length,
             stretch.matched_way, stretch.way_sigma);
  } else {
    way_.Restart();
  }
  if (stretch.turn_is_determined) {
    turn_.Add(Eigen::Vector2d(stretch.odometry_turn, stretch.odometry_way),
              stretch.length + kWheelRadius * stretch.rotation,
              stretch.matched_turn, stretch.turn_sigma);
  } else {
    turn_.Restart();
  }
}

double OdometryCalibration::way_scale() const {
  return Clamped(way_.value(0), options_.way_scale, options_.max_deviation);
}

double OdometryCalibration::turn_scale() const {
  return Clamped(turn_.value(0), options_.turn_scale, options_.max_deviation);
}

double OdometryCalibration::turn_per_metre() const {
  return Clamped(turn_.value(1), options_.turn_per_metre,
                 options_.max_deviation);
}

Pose2 OdometryCalibration::Correct(const Pose2& odometry) const {
  const double turn =
      turn_scale() * odometry.theta + turn_per_metre() * Way(odometry);
  // On an arc the direction changes by half of that.
  const Pose2 bend(0., 0., 0.5 * (turn - odometry.theta));
  const Eigen::Vector2d translation =
      way_scale() * (bend * odometry.translation());
  return Pose2(translation.x(), translation.y(), NormalizeAngle(turn));
}

Eigen::Matrix3d OdometryCalibration::Covariance(const Pose2& odometry) const {
  const double way = Way(odometry);
  const double turn_variance = Squared(turn_sigma() * odometry.theta) +
                               Squared(turn_per_metre_sigma() * way);
  const Eigen::Vector2d forward = Forward(odometry);
  const Eigen::Vector2d across(-forward.y(), forward.x());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      Squared(way_sigma() * way) * forward * forward.transpose() +
      Squared(0.5 * way) * turn_variance * across * across.transpose();
  covariance(2, 2) = turn_variance;
  return covariance;
}

}  // namespace front_end
}  // namespace cartographer_ext
