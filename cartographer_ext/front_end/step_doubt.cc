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
                    const double probability, const bool bridges_gap) {
  const Eigen::Matrix3d adjoint = uncertainty::Adjoint(motion.Inverse());
  sum_.doubt = adjoint * sum_.doubt * adjoint.transpose();
  if (sum_.bridged.has_value()) {
    sum_.bridged = adjoint * *sum_.bridged * adjoint.transpose();
  }
  const Eigen::Matrix3d rotation = PlanarRotation(motion.theta);
  if (bridges_gap) {
    const Eigen::Matrix3d gap = rotation.transpose() * covariance * rotation;
    sum_.bridged = sum_.bridged.has_value() ? *sum_.bridged + gap : gap;
  } else if (probability > 0.) {
    sum_.doubt +=
        probability * rotation.transpose() * Bounded(covariance) * rotation;
  }
}

uncertainty::StepError StepDoubt::Take() {
  const uncertainty::StepError sum = sum_;
  sum_ = uncertainty::StepError();
  return sum;
}

}  // namespace front_end
}  // namespace cartographer_ext
