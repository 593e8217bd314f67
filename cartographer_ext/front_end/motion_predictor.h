// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the robot will be found at the next scan, and how sure that is: from
// odometry, IMU, or the velocity of the last scans, whichever is there and to
// be believed.
//
//   odometry and IMU   the way from odometry, the turn from both, weighed by
//                      their variances
//   odometry alone     its motion over the interval
//   IMU alone          the turn from the IMU, the way from the velocity of
//                      the last scans and the accelerations since then; over a
//                      long gap both preintegrated
//   neither            constant velocity for a while, then no motion
//
// Odometry that the monitor has found at fault is not used as long as the
// velocity does better. An interval that looks wrong before the match (a jump,
// a frozen pose while moving) gets a wide covariance and alternatives to search
// around; the match then tells who was right.
//
// Scans that are matched with one and the same map err alike: a scan that hangs
// on the beginnings of a map goes on hanging there, a little behind odometry
// every time. So odometry is asked for the whole way since the last scan that
// became part of the map, and predicts from where that scan lies; the matches
// in between change nothing of it.
#ifndef CARTOGRAPHER_EXT_FRONT_END_MOTION_PREDICTOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_MOTION_PREDICTOR_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/imu_predictor.h"
#include "cartographer_ext/front_end/odometry_calibration.h"
#include "cartographer_ext/front_end/odometry_monitor.h"
#include "cartographer_ext/front_end/odometry_predictor.h"
#include "cartographer_ext/front_end/velocity_filter.h"

namespace cartographer_ext {
namespace front_end {

struct MotionPredictorOptions {
  bool use_odometry = true;
  OdometryNoiseOptions odometry;
  TimeOffsetOptions time_offset;
  OdometryCalibrationOptions calibration;
  ConstantVelocityOptions constant_velocity;
  OdometryCheckOptions check;
  ImuPredictorOptions imu;
};

enum class PredictionSource { kNothing, kConstantVelocity, kOdometry, kImu };

struct MotionPrediction {
  PredictionSource source = PredictionSource::kNothing;
  Pose2 motion;  // (robot at the last scan <- robot now)
  // Of (x, y, theta) of the motion, in the frame of the robot at the last scan.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  // Not to be relied on: search.
  bool is_uncertain = false;
  // How far the robot may have gone (metres) and turned (radians) from the
  // motions on trial, where nothing tells.
  double unknown_way = 0.;
  double unknown_turn = 0.;
  // Odometry was there at the last scan, and will tell of the gap since then as
  // soon as its next reading comes.
  bool odometry_is_missing = false;
  // Other motions worth a try then.
  std::vector<Pose2> alternatives;
};

// The outcome of a match, for AddMatch.
struct MatchedMotion {
  Pose2 motion;  // (robot at the last scan <- robot now)
  bool way_is_determined = true;
  bool turn_is_determined = true;
  // Of the pose, in the frame of the robot at the last scan.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // The match began with a prediction of the velocity, with or without IMU.
  bool from_velocity = false;
};

class MotionPredictor {
 public:
  explicit MotionPredictor(const MotionPredictorOptions& options);

  // Times in seconds from any one start. Late readings are ignored.
  void AddOdometry(double time, const Pose2& pose);
  void AddImu(const PlanarImuReading& reading);

  // For a scan at `time`, not before the last one. Without a scan before it
  // nothing is predicted.
  MotionPrediction Predict(double time) const;

  // The scan at `time` was matched. Returns what the match says of odometry.
  OdometryState AddMatch(double time, const MatchedMotion& matched);

  // The last scan that was matched became part of the map.
  void AddToMap();

  double time_offset() const { return odometry_.time_offset(); }
  const OdometryCalibration& calibration() const {
    return odometry_.calibration();
  }
  OdometryState odometry_state() const { return monitor_.state(); }
  // Robot's frame, per second; zero before the second match.
  const Pose2& velocity() const { return velocity_.velocity(); }

 private:
  Pose2 VelocityMotion(double interval) const;
  // Where the velocity is a mere guess.
  Eigen::Matrix3d WideCovariance(double interval) const;
  bool PredictOdometry(double time, OdometryMotion* motion) const;
  // Whether the wheels stand still; a match may move a little all the same.
  bool Stands(double time, const Pose2& match) const;
  // By odometry and IMU since the last scan that is in the map.
  void PredictFromMap(double time, MotionPrediction* prediction) const;
  // Forwards, metres a second, over an interval; zero where the bias of the
  // accelerometer may be all there is.
  double SpeedChange(double interval, const ImuMotion& imu) const;
  // Without odometry: the turn of the IMU, and the way of the velocity.
  void PredictInertially(double interval, const ImuMotion& imu,
                         MotionPrediction* prediction) const;
  void UpdateVelocity(double time, const MatchedMotion& matched,
                      double speed_change);
  OdometryState CheckOdometry(double time, const MatchedMotion& matched);
  // Odometry with `not_compared_`, up to `time`.
  OdometryState Compare(double time, bool has_odometry);
  // Covariance of a motion by odometry.
  Eigen::Matrix3d CovarianceOf(const OdometryMotion& odometry,
                               double interval) const;

  const MotionPredictorOptions options_;
  OdometryPredictor odometry_;
  ImuPredictor imu_;
  OdometryMonitor monitor_;
  bool has_match_ = false;
  double last_time_ = 0.;
  VelocityFilter velocity_;
  // The last scan that had odometry, and the matched motion since then.
  bool has_anchor_ = false;
  double anchor_time_ = 0.;
  Pose2 since_anchor_;
  // The scan up to which odometry was compared with the matches, and what was
  // matched since then.
  double compared_time_ = 0.;
  MatchedMotion not_compared_;
  // The last scan that is in the map, or the last one since which odometry is
  // without fault; and the matched motion since then.
  double map_time_ = 0.;
  Pose2 since_map_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_MOTION_PREDICTOR_H_
