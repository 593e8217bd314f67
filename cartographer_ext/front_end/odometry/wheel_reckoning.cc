// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/wheel_reckoning.h"

#include <cmath>

#include "Eigen/Core"
#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Size of a fault, standard deviations: wheels that spin for a second or two.
constexpr double kFaultMetres = 0.8;
constexpr double kFaultRadians = 0.2;

}  // namespace

ReckonedMotion ReckonByWheels(const std::vector<Pose2>& steps,
                              const OdometryCalibration& calibration,
                              const double faults_per_metre) {
  ReckonedMotion result;
  Pose2& sum = result.motion.pose;
  Eigen::Matrix3d random = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();
  for (const Pose2& raw : steps) {
    const Pose2 step = calibration.Correct(raw);
    const double length = raw.translation().norm();
    const double rotation = std::abs(raw.theta);
    const Pose2 back = step.Inverse();
    const Eigen::Matrix3d adjoint = uncertainty::Adjoint(back);
    random = adjoint * random * adjoint.transpose();
    const double faults = faults_per_metre * length;
    const double translation_variance =
        calibration.TranslationVariance(length) +
        faults * Squared(kFaultMetres);
    random.diagonal() +=
        Eigen::Vector3d(translation_variance, translation_variance,
                        calibration.RotationVariance(length, rotation) +
                            faults * Squared(kFaultRadians));
    common = adjoint * common;
    common(2, 0) += std::copysign(length, raw.x);
    common(2, 1) += raw.theta;
    common.col(2).head<2>() -= back.translation();
    sum = sum * step;
    result.length += length;
  }
  const Eigen::Vector3d sigmas(calibration.rotation_per_metre_sigma(),
                               calibration.rotation_scale_sigma(),
                               calibration.translation_scale_sigma());
  common = common * sigmas.asDiagonal();
  result.motion.covariance = random + common * common.transpose();
  return result;
}

}  // namespace front_end
}  // namespace cartographer_ext
