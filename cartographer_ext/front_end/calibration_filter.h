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
//
// How noisy the increments really are depends on the wheels, the laser, and how
// far scans are apart. The squares of the residuals by their variances are one on
// average if the noise is as assumed. Their mean is the factor of the variance of
// the noise (the dispersion of a generalised linear model), estimated with
// residuals limited to three standard deviations ("Robust Estimation of a
// Location Parameter", proposal 2, Annals of Mathematical Statistics 35, 1964).
// It is never below one. It widens the bound of residuals and the reported sigmas.
// Increments that the uncertainty of p dominates count less.
#ifndef CARTOGRAPHER_EXT_FRONT_END_CALIBRATION_FILTER_H_
#define CARTOGRAPHER_EXT_FRONT_END_CALIBRATION_FILTER_H_

#include <limits>

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
    // Increments that this noise counts as, when its factor is estimated;
    // infinite: it is known.
    double worth = std::numeric_limits<double>::infinity();
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
  // Of the variance of the noise, >= 1.
  double noise_factor() const;

 private:
  // One residual of the sum y, see above; `variance` is as assumed.
  void CountResidual(const Eigen::Vector2d& regressors, double square_residual,
                     double variance);

  const Eigen::Vector2d initial_variances_;
  const Eigen::Vector2d floors_;
  const Noise noise_;
  Eigen::Vector3d state_;  // p, then y minus the measured one
  Eigen::Matrix3d covariance_;
  double num_increments_ = 0.;  // sum of their weights
  double sum_of_squares_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_CALIBRATION_FILTER_H_
