// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/step_doubt.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/uncertainty/uncertain_pose.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Standard deviations of a pose anywhere in the window of a search.
constexpr double kMostTranslation = 0.3;  // metres
constexpr double kMostRotation = 0.4;     // radians

// `covariance` with its standard deviations shortened to those.
Eigen::Matrix3d Bounded(const Eigen::Matrix3d& covariance) {
  const double translation = uncertainty::WorstTranslationSigma(covariance);
  const double rotation = std::sqrt(std::max(0., covariance(2, 2)));
  const double a =
      translation > kMostTranslation ? kMostTranslation / translation : 1.;
  const double b = rotation > kMostRotation ? kMostRotation / rotation : 1.;
  const Eigen::Vector3d scale(a, a, b);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

void StepDoubt::Add(const Pose2& motion, const Eigen::Matrix3d& covariance,
                    const double probability) {
  const Eigen::Matrix3d adjoint = uncertainty::Adjoint(motion.Inverse());
  sum_ = adjoint * sum_ * adjoint.transpose();
  if (!(probability > 0.)) return;
  const Eigen::Matrix3d rotation = PlanarRotation(motion.theta);
  sum_ += probability * rotation.transpose() * Bounded(covariance) * rotation;
}

Eigen::Matrix3d StepDoubt::Take() {
  const Eigen::Matrix3d sum = sum_;
  sum_.setZero();
  return sum;
}

}  // namespace front_end
}  // namespace cartographer_ext
