// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Prediction from odometry: the motion over the very interval between two
// scans, taken at their stamps less the clock offset, and its covariance.
//
// (A velocity taken from odometry before the interval, as the stock
// extrapolator has it, is one scan late: after a gap it goes on turning the way
// the robot turned before.)
//
// Noise of a differential drive over a way d and a turn a, standard deviations
// in the robot's frame at the start of the interval:
//   along    translation + per_metre |d|
//   across   the same, and d / 2 times that of the turn
//   turn     rotation + per_radian |a| + per_metre |d|
// Besides, what the calibration leaves unknown.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_PREDICTOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_PREDICTOR_H_

#include <deque>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/odometry/odometry_buffer.h"
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"
#include "cartographer_ext/front_end/odometry/time_offset.h"

namespace cartographer_ext {
namespace front_end {

struct OdometryNoiseOptions {
  double translation = 0.01;  // metres
  double translation_per_metre = 0.1;
  double rotation = 0.005;  // radians
  double rotation_per_radian = 0.2;
  double rotation_per_metre = 0.02;
  double max_extrapolation = 0.3;  // seconds
};

struct OdometryMotion {
  Pose2 motion;  // (robot at `from` <- robot at `to`), corrected
  Pose2 raw;     // the same as it came
  // Of (x, y, theta) of the motion, in the frame of the robot at `from`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  bool frozen = false;  // one pose is repeated at the start or the end
  // The end lies further beyond the last reading than an extrapolation is good
  // for, but not further than the usual interval of the readings: the motion is
  // hardly better known than by constant velocity.
  bool is_late = false;
};

// The covariance above for a motion.
Eigen::Matrix3d OdometryCovariance(const OdometryNoiseOptions& options,
                                   const Pose2& motion);

class OdometryPredictor {
 public:
  OdometryPredictor(const OdometryNoiseOptions& noise,
                    const TimeOffsetOptions& offset,
                    const OdometryCalibrationOptions& calibration);

  bool Add(double time, const Pose2& pose) { return buffer_.Add(time, pose); }

  // The motion between two stamps of scans, seconds, from < to. False when
  // there is no odometry around them.
  bool Predict(double from, double to, OdometryMotion* motion) const;

  // What the scan matcher found between the same two stamps, to learn the clock
  // offset from, as soon as the odometry of all offsets on trial is there. Only
  // for matches that are sure of the turn.
  void AddMatch(double from, double to, const Pose2& match);

  // What a match says of the scales; see there.
  void Calibrate(const CalibrationInterval& interval) {
    calibration_.Add(interval);
  }

  const OdometryCalibration& calibration() const { return calibration_; }
  // Scan minus odometry stamp, seconds.
  double time_offset() const { return offset_.offset(); }

 private:
  struct MatchedTurn {
    double from;
    double to;
    double turn;
  };
  void LearnOffset(const MatchedTurn& matched);

  const OdometryNoiseOptions noise_;
  OdometryBuffer buffer_;
  TimeOffsetEstimator offset_;
  OdometryCalibration calibration_;
  std::deque<MatchedTurn> pending_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_PREDICTOR_H_
