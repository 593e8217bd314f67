// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Predicts the motion of the robot between two scans, with its covariance, from
// whichever of odometry, IMU and the velocity of the last scans is available
// and trusted:
//
//   odometry and IMU   translation of odometry; rotation of both, weighted by
//                      their variances, once the gyroscope is proven; over a
//                      gap dead reckoning by both (dead_reckoning.h)
//   odometry alone     its motion over the interval
//   IMU alone          rotation of the IMU; translation from the velocity of
//                      the last scans and the acceleration since then; over a
//                      long gap both preintegrated
//   neither            constant velocity for a while, then no motion
//
// Odometry that the monitor has found faulty is not used as long as the
// velocity predicts better. An interval that looks wrong before the match (a
// jump, a repeated pose while moving) gets a large covariance and alternative
// motions to search around; the match then decides between them.
//
// Odometry that has repeated its first pose ever since may be dead (no encoder, a
// driver that publishes zeros). That the robot stands still it says without weight,
// so that it does not hold the matches of one that drives, and once the robot has
// moved it is not used until it moves, too.
//
// Scans matched against the same submap have correlated errors: against a map
// of few scans, every match may fall a little short of the true motion, and the
// errors add up. So odometry predicts over the whole interval since the last
// scan that was inserted into the map, starting from the pose of that scan; the
// matches in between do not contribute.
#ifndef CARTOGRAPHER_EXT_FRONT_END_MOTION_PREDICTOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_MOTION_PREDICTOR_H_

#include <functional>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/dead_reckoning.h"
#include "cartographer_ext/front_end/imu/gyroscope.h"
#include "cartographer_ext/front_end/imu/imu_predictor.h"
#include "cartographer_ext/front_end/odometry/learnt_odometry_noise.h"
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"
#include "cartographer_ext/front_end/odometry/odometry_monitor.h"
#include "cartographer_ext/front_end/odometry/odometry_predictor.h"
#include "cartographer_ext/front_end/velocity_filter.h"

namespace cartographer_ext {
namespace front_end {

// Options of the sources of a prediction.
struct MotionPredictorOptions {
  bool use_odometry = true;
  OdometryNoiseOptions odometry;
  TimeOffsetOptions time_offset;
  OdometryCalibrationOptions calibration;
  LearntOdometryNoiseOptions odometry_noise;
  ConstantVelocityOptions constant_velocity;
  OdometryCheckOptions check;
  ImuPredictorOptions imu;
};

// The main source of a prediction.
enum class PredictionSource { kNothing, kConstantVelocity, kOdometry, kImu };

// The predicted motion between two scans.
struct MotionPrediction {
  PredictionSource source = PredictionSource::kNothing;
  Pose2 motion;  // (robot at the last scan <- robot now)
  // Of (x, y, theta) of the motion, in the frame of the robot at the last scan.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  // The prediction may be wrong by more than its covariance; the matcher should
  // search.
  bool is_uncertain = false;
  // Half widths of the search window around `motion` and `alternatives`, in
  // metres and radians, where no sensor measured the motion; otherwise zero.
  double search_radius = 0.;
  double search_angle = 0.;
  // Of odometry alone, without a gyroscope.
  bool heading_by_wheels = false;
  // By dead reckoning over metres without a scan; the covariance is the error of
  // that.
  bool bridges_gap = false;
  // Odometry covered the last scan and its next reading will cover the gap
  // since then.
  bool odometry_pending = false;
  // Other motions, and those that only start a search if they are within the
  // window around `motion`: what it finds must agree with the prediction.
  std::vector<Pose2> alternatives;
  std::vector<Pose2> hints;
};

// The outcome of a match, for AddMatch.
struct MatchedMotion {
  Pose2 motion;  // (robot at the last scan <- robot now)
  // Whether the scan determines the translation along the direction of motion,
  // and the rotation.
  bool translation_observable = true;
  bool rotation_observable = true;
  // The heading by the scan alone minus that of the match, and its standard
  // deviation, radians.
  double scan_heading = 0.;
  double scan_heading_sigma = 0.;
  // Mean distance of the points of the scan, metres.
  double mean_range = 0.;
  // Scans of the submap that it was matched against.
  int scans_in_map = 1000;
  // Of the pose, in the frame of the robot at the last scan.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // The match started from a prediction by the velocity, with or without IMU.
  bool from_velocity = false;
  // The matcher holds the odometry of this motion for wrong.
  bool overrules_odometry = false;
  // It makes up for errors of several motions before.
  bool ends_contest = false;
  // Then that of the last scan alone: what the velocity is.
  Pose2 rival_motion;
  // See MotionComparison; used while it is added only.
  std::function<double(const Pose2&)> evidence;
};

// Predicts the motion between scans, see above. Not thread-safe.
class MotionPredictor {
 public:
  explicit MotionPredictor(const MotionPredictorOptions& options);

  // Times in seconds since an arbitrary start. Readings that are not later than
  // the one before are ignored.
  void AddOdometry(double time, const Pose2& pose);
  void AddImu(const PlanarImuReading& reading);

  // For a scan at `time`, not before the last one. Before the first match
  // nothing is predicted.
  MotionPrediction Predict(double time) const;

  // The scan at `time` was matched. Returns the state of odometry over the
  // interval.
  OdometryState AddMatch(double time, const MatchedMotion& matched);

  // How a match, not one from a search, differed from a prediction by odometry.
  void AddInnovation(const MatchInnovation& innovation);

  // The scan matched last was inserted into the map.
  void AddInsertion();

  // How wide the laser sees, radians; half a circle and more before it is
  // known.
  void SetFieldOfView(double angle);

  double time_offset() const { return odometry_.time_offset(); }
  const OdometryCalibration& calibration() const {
    return odometry_.calibration();
  }
  const Gyroscope& gyroscope() const { return imu_.gyroscope(); }
  OdometryState odometry_state() const { return monitor_.state(); }
  // In the robot's frame, per second; zero before the second match.
  const Pose2& velocity() const { return velocity_.velocity(); }

 private:
  // The sources of a prediction, in the order in which they replace each other.
  MotionPrediction PredictByVelocity(double interval) const;
  void PredictByImu(double interval, const ImuMotion& imu,
                    MotionPrediction* prediction) const;
  // `prediction` is that without odometry.
  void PredictByOdometry(double time, const OdometryMotion& odometry,
                         bool has_imu, MotionPrediction* prediction) const;
  // By odometry and IMU since the last insertion.
  void PredictFromInsertion(double time, MotionPrediction* prediction) const;

  // Integrates the IMU between two times.
  bool IntegrateImu(double from, double to, ImuMotion* motion) const;
  // Odometry between two times, over a gap by dead reckoning; the heading by the
  // gyroscope where that is proven.
  bool IntegrateOdometry(double from, double to, OdometryMotion* motion) const;
  bool PredictByWheels(double from, double to, OdometryMotion* motion) const;
  // Where the velocity is hardly known.
  Eigen::Matrix3d WideCovariance(double interval) const;
  Eigen::Matrix3d OdometryMotionCovariance(const OdometryMotion& odometry,
                                           double interval) const;
  // Forwards, in metres per second, over an interval; zero within the
  // uncertainty of the accelerometer's bias.
  double SpeedChange(double interval, const ImuMotion& imu) const;
  // Whether odometry jumped since the last scan.
  bool HasJump(double time) const;
  bool IsOdometryDead() const { return was_stale_ && !odometry_.has_moved(); }
  // The wheels do not move, and the match only by its noise.
  bool IsStationary(double time, const Pose2& match) const;

  OdometryState CheckOdometry(double time, const MatchedMotion& matched);
  // Of the wheels, over short parts of the interval; none without odometry.
  std::vector<WheelSpeed> SpeedsBetween(double from, double to) const;
  // Compares odometry with `uncompared_`, up to `time`.
  OdometryState Compare(double time, bool has_odometry,
                        const std::function<double(const Pose2&)>& evidence);
  void UpdateVelocity(double time, const MatchedMotion& matched,
                      double speed_change);
  void UpdateInsertion(double time, const MatchedMotion& matched,
                       OdometryState state);

  const MotionPredictorOptions options_;
  OdometryPredictor odometry_;
  ImuPredictor imu_;
  DeadReckoning reckoning_;
  OdometryMonitor monitor_;
  bool was_stale_ = false;  // odometry, at any time
  LearntOdometryNoise odometry_noise_;
  bool has_match_ = false;
  double last_time_ = 0.;
  VelocityFilter velocity_;
  // That odometry and matches agreed on, m/s and rad/s.
  double fastest_ = 0., fastest_turn_ = 0.;
  // The last scan covered by odometry, and the matched motion since then.
  bool has_anchor_ = false;
  double anchor_time_ = 0.;
  Pose2 since_anchor_;
  // The scan up to which odometry was compared with the matches, and the
  // matched motion since then.
  double compared_time_ = 0.;
  MatchedMotion uncompared_;
  // The last scan inserted into the map, or a later one before which odometry
  // was faulty, and the matched motion since then.
  double insertion_time_ = 0.;
  Pose2 since_insertion_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_MOTION_PREDICTOR_H_
