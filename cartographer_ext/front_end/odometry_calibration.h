// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Online calibration of wheel odometry: what its way and its turn must be
// multiplied with. In a corridor without features the length of the map is that
// of odometry, whose scale (tyres, load) is known to one or two per cent; where
// the scan did tell the way before, the scale can be learnt.
//
//   way  = way_scale * way of odometry
//   turn = turn_scale * turn of odometry + turn_per_metre * way of odometry
// The last is what unequal wheels do, the one before what a wrong wheel base
// does.
//
// Each of the two lines is the state of a small Kalman filter, together with y,
// the way (turn) that odometry makes of the robot's: an augmented filter, as in
// A. Martinelli, N. Tomatis, R. Siegwart, "Simultaneous localization and
// odometry self calibration for mobile robot", Autonomous Robots 22 (2007), in
// one dimension, along the way. Over h = (ways and turns of odometry)
//   y <- y + p . h,   variance of y + walk^2 |h|,   p wanders a little,
// and the scan matcher measures y with a standard deviation of its own. So two
// matches that err alike (against one and the same map) are compared over all
// the way between them: over 10 m errors of 1 cm are one of 0.14 % in the
// scale, not ten of 1.4 %. `walk` holds what goes with the way: wheel noise,
// and the errors of maps that are matched with each other.
//
// It is learnt only
//  * between scans that tell the way (the turn) by themselves: where one does
//    not, its match is odometry, and would confirm any scale;
//  * while the check of odometry finds nothing, and no sooner than some seconds
//    after: a slip is seen when it has lasted a while;
//  * from matches that agree with the filter: a place found anew is where y
//    begins anew.
// To what the filter claims a floor is added that stands for what maps and
// lasers err by as a whole.
#ifndef CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_CALIBRATION_H_
#define CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_CALIBRATION_H_

#include <deque>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace front_end {

// Errors are standard deviations.
struct OdometryCalibrationOptions {
  bool estimate_way = true;
  bool estimate_turn = false;
  double way_scale = 1.;  // before anything is learnt
  double way_sigma = 0.02;
  double turn_scale = 1.;
  double turn_sigma = 0.03;
  double turn_per_metre = 0.;  // radians per metre
  double turn_per_metre_sigma = 0.02;
  // Farther from the first values nothing is corrected: of the scales, and in
  // radians per metre.
  double max_deviation = 0.1;
};

// The line of one of both, p and y as above.
class CalibrationFilter {
 public:
  struct Noise {
    double match;         // of a matched way or turn
    double walk;          // of y, per root of what odometry went or turned
    double wander;        // of p, per root of the same
    double max_residual;  // in standard deviations
  };

  // p begins with `values`; a sigma of 0 holds a value. The sigmas that are
  // told contain `floors`.
  CalibrationFilter(const Eigen::Vector2d& values,
                    const Eigen::Vector2d& sigmas,
                    const Eigen::Vector2d& floors, const Noise& noise);

  // Odometry went on by `regressors`, `length` for the noise, and the match by
  // `matched`, with `extra` as standard deviation besides that of a match.
  // False when they contradict each other: nothing is learnt but that y begins
  // anew.
  bool Add(const Eigen::Vector2d& regressors, double length, double matched,
           double extra);

  // What comes is not connected with what was.
  void Restart();

  double value(const int i) const { return state_(i); }
  double sigma(int i) const;

 private:
  const Eigen::Vector2d initial_variances_;
  const Eigen::Vector2d floors_;
  const Noise noise_;
  Eigen::Vector3d state_;  // p, then y less what was matched
  Eigen::Matrix3d covariance_;
};

// One interval between two scans. Motions are (earlier robot <- later robot).
struct CalibrationInterval {
  double time = 0.;      // of the later scan, seconds
  double interval = 0.;  // seconds, > 0
  Pose2 odometry;        // as it came, not corrected
  Pose2 match;
  // Odometry is there, and nothing is wrong with it.
  bool is_sound = true;
  bool way_is_determined = true;
  bool turn_is_determined = true;
  // Of the later pose, in the frame of the robot at the earlier one.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

class OdometryCalibration {
 public:
  explicit OdometryCalibration(const OdometryCalibrationOptions& options);

  void Add(const CalibrationInterval& interval);

  // The motion by odometry, corrected. For a way that is short against its
  // curves: some metres.
  Pose2 Correct(const Pose2& odometry) const;

  // What the correction adds to the covariance of such a motion, (x, y, theta)
  // in the frame of its start.
  Eigen::Matrix3d Covariance(const Pose2& odometry) const;

  double way_scale() const;
  double way_sigma() const { return way_.sigma(0); }
  double turn_scale() const;
  double turn_sigma() const { return turn_.sigma(0); }
  double turn_per_metre() const;  // radians per metre
  double turn_per_metre_sigma() const { return turn_.sigma(1); }

 private:
  // Motion between two scans that the filters compare.
  struct Stretch {
    double time = 0.;          // of its end
    double odometry_way = 0.;  // signed, as is all but the length
    double odometry_turn = 0.;
    double matched_way = 0.;
    double matched_turn = 0.;
    double length = 0.;    // of the way
    double rotation = 0.;  // all turns
    // Standard deviations at the end, of stamps too.
    double way_sigma = 0.;
    double turn_sigma = 0.;
    bool way_is_determined = true;
    bool turn_is_determined = true;
  };

  void Learn(const Stretch& stretch);
  void Discard(double time);

  const OdometryCalibrationOptions options_;
  CalibrationFilter way_;
  CalibrationFilter turn_;
  Stretch current_;
  // Not yet learnt from, oldest first.
  std::deque<Stretch> pending_;
  // The filters are to begin anew with the next stretch.
  bool is_broken_ = true;
  bool has_fault_ = false;
  double fault_time_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_ODOMETRY_CALIBRATION_H_
