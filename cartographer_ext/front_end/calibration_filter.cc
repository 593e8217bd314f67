// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/calibration_filter.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// A squared residual counts at most as that of three standard deviations, so that
// those of slip do not pass for noise.
constexpr double kMaxSquare = 9.;
// Mean of min(x^2, kMaxSquare) of a standard normal x.
constexpr double kMeanSquare = 0.9950;

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

void CalibrationFilter::Set(const int i, const double value,
                            const double sigma) {
  state_(i) = value;
  covariance_.row(i).setZero();
  covariance_.col(i).setZero();
  covariance_(i, i) = std::min(initial_variances_(i), Squared(sigma));
}

double CalibrationFilter::noise_factor() const {
  if (!std::isfinite(noise_.worth)) return 1.;
  return std::max(
      1., (noise_.worth + sum_of_squares_) / (noise_.worth + num_increments_));
}

double CalibrationFilter::sigma(const int i) const {
  const double initial = initial_variances_(i);
  if (covariance_(i, i) <= 0.) return std::min(std::sqrt(initial), floors_(i));
  // Only what the increments tell is less certain with more noise.
  const double learnt =
      std::max(0., 1. / covariance_(i, i) - 1. / initial) / noise_factor();
  return std::sqrt(
      std::min(initial, 1. / (1. / initial + learnt) + Squared(floors_(i))));
}

void CalibrationFilter::CountResidual(const Eigen::Vector2d& regressors,
                                      const double square_residual,
                                      const double variance) {
  const double by_parameters =
      regressors.dot(covariance_.topLeftCorner<2, 2>() * regressors);
  const double weight = std::max(0., 1. - by_parameters / variance);
  const double most = kMaxSquare * noise_factor();
  num_increments_ += weight;
  sum_of_squares_ +=
      weight * std::min(square_residual / variance, most) / kMeanSquare;
}

bool CalibrationFilter::Add(const Eigen::Vector2d& regressors,
                            const double length, const double measured,
                            const double extra, const double walk) {
  Eigen::Matrix3d transition = Eigen::Matrix3d::Identity();
  transition.row(2).head<2>() = regressors.transpose();
  state_ = transition * state_;
  covariance_ = transition * covariance_ * transition.transpose();
  covariance_(2, 2) += Squared(noise_.walk) * length + Squared(walk);
  for (int i = 0; i < 2; ++i) {
    // The variance never exceeds the initial one.
    covariance_(i, i) +=
        std::min(Squared(noise_.wander) * length,
                 std::max(0., initial_variances_(i) - covariance_(i, i)));
  }

  const double measurement = Squared(noise_.match) + Squared(extra);
  const double variance = covariance_(2, 2) + measurement;
  const double residual = measured - state_.z();
  if (!std::isfinite(residual)) {
    Restart();
    return false;
  }
  const double bound = Squared(noise_.max_residual) * noise_factor() * variance;
  CountResidual(regressors, Squared(residual), variance);
  if (Squared(residual) > bound) {
    Restart();
    return false;
  }
  const Eigen::Vector3d gain = covariance_.col(2) / variance;
  state_ += gain * residual;
  // The Joseph form keeps the covariance positive semi-definite.
  Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
  rest.col(2) -= gain;
  covariance_ = Symmetric(rest * covariance_ * rest.transpose() +
                          measurement * gain * gain.transpose());
  state_.z() -= measured;
  return true;
}

}  // namespace front_end
}  // namespace cartographer_ext
