// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates the two parameters p of a sensor of motion from matched scans:
//
//   measured increment = p . h
//
// with the regressors h of the increment. They are the state of a Kalman filter,
// together with y, the sum of the increments as the sensor has it: an augmented
// filter, as in A. Martinelli, N. Tomatis, R. Siegwart, "Simultaneous
// localization and odometry self calibration for mobile robot", Autonomous
// Robots 22 (2007), in one dimension. Over an increment h of length l
//
//   y <- y + p . h,   variance of y + walk^2 l,   p random walk,
//
// and y is measured with the standard deviation of a match. Two matches with a
// correlated error (against the same submap) are thus compared over everything
// between them: over 10 m, errors of 1 cm are one of 0.14 % in a scale, not ten
// of 1.4 %.
#ifndef CARTOGRAPHER_EXT_FRONT_END_CALIBRATION_FILTER_H_
#define CARTOGRAPHER_EXT_FRONT_END_CALIBRATION_FILTER_H_

#include "Eigen/Core"

namespace cartographer_ext {
namespace front_end {

// The filter above. Not thread-safe.
class CalibrationFilter {
 public:
  struct Noise {
    double match;         // of a matched translation or rotation
    double walk;          // of y, per root of the length of the increment
    double wander;        // of p, per root of the same
    double max_residual;  // in standard deviations
  };

  // Initial p and its sigmas; a sigma of 0 keeps a parameter constant. sigma()
  // includes `floors`.
  CalibrationFilter(const Eigen::Vector2d& values,
                    const Eigen::Vector2d& sigmas,
                    const Eigen::Vector2d& floors, const Noise& noise);

  // An increment `regressors` (`length` for the noise) and the measured
  // increment; `extra` is a standard deviation beyond that of a match, `walk` one
  // of y beyond its noise. Returns false and restarts when the two are
  // inconsistent.
  bool Add(const Eigen::Vector2d& regressors, double length, double measured,
           double extra, double walk = 0.);

  // The next increment does not continue the last one.
  void Restart();

  // Parameter i is known from elsewhere, with this standard deviation.
  void Set(int i, double value, double sigma);

  double value(const int i) const { return state_(i); }
  double sigma(int i) const;

 private:
  const Eigen::Vector2d initial_variances_;
  const Eigen::Vector2d floors_;
  const Noise noise_;
  Eigen::Vector3d state_;  // p, then y minus the measured one
  Eigen::Matrix3d covariance_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_CALIBRATION_FILTER_H_
