// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Online calibration of wheel odometry. In a corridor without features the
// length of the map is that of odometry, whose scale (tyres, load) is known to
// one or two per cent. Where scans did measure the translation before, the
// scale can be estimated:
//
//   translation = translation_scale * odometry translation
//   rotation    = rotation_scale * odometry rotation
//                 + rotation_per_metre * odometry translation
//
// Unequal wheels cause rotation_per_metre, a wrong wheel base rotation_scale.
// Of rotation, the match is by far more precise than the wheels. A regression
// on odometry would be diluted by the noise of the wheels: on straight ways,
// where they turn by noise alone, the best scale is zero. So the second line is
// estimated the other way round,
//
//   odometry rotation = (rotation - rotation_per_metre * odometry translation)
//                       / rotation_scale.
//
// Each line is estimated by a CalibrationFilter. `walk` of a filter covers errors
// that grow with distance: wheel noise, and the errors of submaps matched with
// each other.
//
// A filter is updated only
//  * between scans that measure the translation (the rotation) themselves:
//    otherwise the match is odometry and would confirm any scale;
//  * while the check of odometry finds no fault, and not until some seconds
//    after a fault: slip is detected with a delay;
//  * from matches that agree with it: after relocalisation it restarts.
//
// The reported sigma includes a floor for systematic errors of maps and lasers.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_CALIBRATION_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_CALIBRATION_H_

#include <deque>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/front_end/calibration_filter.h"

namespace cartographer_ext {
namespace front_end {

// Errors are standard deviations.
struct OdometryCalibrationOptions {
  bool estimate_odometry_scale = true;  // translation_scale
  bool estimate_rotation = true;        // rotation_scale, rotation_per_metre
  double translation_scale = 1.;        // initial value
  // Of a robot as it comes: tyres and load change the scale by one or two per
  // cent.
  double translation_scale_sigma = 0.02;
  double rotation_scale = 1.;
  double rotation_scale_sigma = 0.03;
  double rotation_per_metre = 0.;  // radians per metre
  double rotation_per_metre_sigma = 0.02;
  // Limit of the correction around the initial values, of the scales and in
  // radians per metre. Wheels and wheel bases of cheap robots are off by a tenth,
  // and those of another robot in the configuration of the driver by more.
  double max_deviation = 0.3;
};

// One interval between two scans. Motions are (earlier robot <- later robot).
struct CalibrationInterval {
  double time = 0.;      // of the later scan, seconds
  double interval = 0.;  // seconds, > 0
  Pose2 odometry;        // as received, not corrected
  Pose2 match;
  // Odometry is available and without fault.
  bool is_sound = true;
  bool translation_observable = true;
  bool rotation_observable = true;
  // Of the later pose, in the frame of the robot at the earlier one.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// Calibrates odometry online, see above. Not thread-safe.
class OdometryCalibration {
 public:
  explicit OdometryCalibration(const OdometryCalibrationOptions& options);

  void Add(const CalibrationInterval& interval);

  // The corrected motion by odometry. Approximates the path by an arc; for some
  // metres at most.
  Pose2 Correct(const Pose2& odometry) const;

  // The covariance of the correction of such a motion, (x, y, theta) in the
  // frame of its start.
  Eigen::Matrix3d Covariance(const Pose2& odometry) const;

  // Random errors of the wheels over a path of so many metres and a sum of
  // absolute rotations of so many radians: square metres, square radians.
  double TranslationVariance(double length) const;
  double RotationVariance(double length, double rotation) const;

  double translation_scale() const;
  double translation_scale_sigma() const;
  double rotation_scale() const;
  double rotation_scale_sigma() const;
  double rotation_per_metre() const;  // radians per metre
  double rotation_per_metre_sigma() const;

 private:
  // Whether a time between two scans is much longer than those before it.
  bool IsGap(double interval);

  // The motion between two scans that the filters compare.
  struct Segment {
    double time = 0.;                  // of its end
    double odometry_translation = 0.;  // signed
    double odometry_rotation = 0.;
    double matched_translation = 0.;
    double matched_rotation = 0.;
    double length = 0.;    // of the path
    double rotation = 0.;  // sum of absolute rotations
    // Standard deviations at the end, including that of stamps.
    double translation_sigma = 0.;
    double rotation_sigma = 0.;
    bool translation_observable = true;
    bool rotation_observable = true;
  };

  void Learn(const Segment& segment);
  void Discard(double time);

  const OdometryCalibrationOptions options_;
  CalibrationFilter translation_filter_;
  CalibrationFilter rotation_filter_;
  Segment current_;
  std::deque<double> intervals_;  // between scans, newest last, seconds
  // Not processed yet, oldest first.
  std::deque<Segment> pending_;
  // The filters restart with the next segment.
  bool must_restart_ = true;
  bool has_fault_ = false;
  double fault_time_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_ODOMETRY_CALIBRATION_H_
