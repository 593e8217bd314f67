// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Prediction from odometry: the motion over exactly the interval between two
// scans, at their stamps less the clock offset, and its covariance.
//
// (A velocity from odometry before the interval, as in the stock extrapolator,
// is one scan late: after a gap it continues the rotation from before the gap.)
//
// Noise of a differential drive over a distance d and a rotation a, standard
// deviations in the robot's frame at the start of the interval:
//
//   along      translation + per_metre |d|
//   across     the same, and d / 2 times that of the rotation
//   rotation   rotation + per_radian |a| + per_metre |d|
//
// The uncertainty of the calibration is added.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_PREDICTOR_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_PREDICTOR_H_

#include <cstddef>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/odometry/clock_offset.h"
#include "cartographer_ext/front_end/odometry/odometry_buffer.h"
#include "cartographer_ext/front_end/odometry/odometry_calibration.h"

namespace cartographer_ext {
namespace front_end {

// Gaps between scans up to this long are bridged, seconds. A laser of short range
// crosses a hall or a square without a single echo.
constexpr double kOdometryBufferSeconds = 3600.;
constexpr size_t kMaxOdometryReadings = 20000;

// Standard deviations above. The defaults suit any wheeled robot: they are wide
// enough that a scan which determines a direction decides it, and finite so
// that odometry decides the others.
struct OdometryNoiseOptions {
  double translation = 0.01;  // metres, of a stationary robot
  double translation_per_metre = 0.1;
  double rotation = 0.005;  // radians, of a stationary robot
  double rotation_per_radian = 0.2;
  double rotation_per_metre = 0.02;
  // How far beyond its last reading odometry is extrapolated: some intervals
  // between messages. Later the prediction goes on without it.
  double max_extrapolation = 0.3;  // seconds
};

// A motion by odometry.
struct OdometryMotion {
  Pose2 motion;  // (robot at `from` <- robot at `to`), corrected
  Pose2 raw;     // the same, not corrected
  // Of (x, y, theta) of the motion, in the frame of the robot at `from`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  bool frozen = false;  // one pose is repeated at the start or the end
  // The end is later than the last reading by more than max_extrapolation, but
  // not by more than the usual interval between readings: the motion is hardly
  // more certain than by constant velocity.
  bool is_late = false;
  // The heading is that of the gyroscope (dead_reckoning.h).
  bool by_gyroscope = false;
  // Of a gap, with the errors of one (wheel_reckoning.h).
  bool is_reckoned = false;
};

// The second moment of an error that is the difference of two motions.
Eigen::Matrix3d Spread(const Pose2& a, const Pose2& b);

// The covariance above for a motion.
Eigen::Matrix3d OdometryCovariance(const OdometryNoiseOptions& options,
                                   const Pose2& motion);

// The same with another variance of the rotation, square radians.
Eigen::Matrix3d TravelCovariance(const OdometryNoiseOptions& options,
                                 const Pose2& motion, double rotation_variance);

// Replaces the rotation by the mean with another, independent one, weighted by
// their variances: radians, square radians.
void FuseRotation(double angle, double variance, OdometryMotion* odometry);

// Predicts from odometry, see above. Not thread-safe.
class OdometryPredictor {
 public:
  OdometryPredictor(const OdometryNoiseOptions& noise,
                    const TimeOffsetOptions& offset,
                    const OdometryCalibrationOptions& calibration);

  bool Add(double time, const Pose2& pose) { return buffer_.Add(time, pose); }

  // The motion between two stamps of scans, seconds, from < to. False when
  // readings do not cover them.
  bool Predict(double from, double to, OdometryMotion* motion) const;

  // Reckons a motion that Predict() has found step by step where that makes a
  // difference (wheel_reckoning.h); otherwise it stays.
  void Reckon(double from, double to, double faults_per_metre,
              OdometryMotion* motion) const;

  // The motion of the scan matcher between two stamps, from which the clock
  // offset is estimated as soon as odometry covers all candidate offsets. Only
  // for matches with an observable rotation.
  void AddMatch(double from, double to, const Pose2& match);

  // Of the readings between two scans.
  bool HasJump(double from, double to, const OdometryJump& jump) const {
    return buffer_.HasJump(from - time_offset(), to - time_offset(), jump);
  }
  bool has_moved() const { return buffer_.has_moved(); }

  // Updates the calibration.
  void Calibrate(const CalibrationInterval& interval) {
    calibration_.Add(interval);
  }

  const OdometryCalibration& calibration() const { return calibration_; }
  // Scan minus odometry stamp, seconds.
  double time_offset() const { return offset_.offset(); }

 private:
  const OdometryNoiseOptions noise_;
  OdometryBuffer buffer_;
  ClockOffset offset_;
  OdometryCalibration calibration_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_PREDICTOR_H_
