// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/uncertain_pose.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Cholesky"
#include "Eigen/Eigenvalues"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace uncertainty {

double WorstTranslationSigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      Eigen::Matrix2d(covariance.topLeftCorner<2, 2>()),
      Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0., solver.eigenvalues()(1)));
}

Eigen::Matrix3d Adjoint(const Pose2& pose) {
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  Eigen::Matrix3d adjoint;
  adjoint << c, -s, pose.y, s, c, -pose.x, 0., 0., 1.;
  return adjoint;
}

UncertainPose Compose(const UncertainPose& lhs, const UncertainPose& rhs) {
  UncertainPose result;
  result.pose = lhs.pose * rhs.pose;
  const Eigen::Matrix3d adjoint = Adjoint(rhs.pose.Inverse());
  result.covariance =
      adjoint * lhs.covariance * adjoint.transpose() + rhs.covariance;
  return result;
}

UncertainPose Invert(const UncertainPose& pose) {
  UncertainPose result;
  result.pose = pose.pose.Inverse();
  const Eigen::Matrix3d adjoint = Adjoint(pose.pose);
  result.covariance = adjoint * pose.covariance * adjoint.transpose();
  return result;
}

UncertainPose Between(const UncertainPose& a, const UncertainPose& b) {
  return Compose(Invert(a), b);
}

bool InvertCovariance(const Eigen::Matrix3d& covariance,
                      Eigen::Matrix3d* const information) {
  if (!covariance.allFinite()) return false;
  // Metres and radians may be orders of magnitude apart: factor the matrix of
  // correlations.
  const Eigen::Vector3d variances = covariance.diagonal();
  if (!(variances.minCoeff() > 0.)) return false;
  const Eigen::Vector3d scale = variances.cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d correlation =
      scale.asDiagonal() * Symmetric(covariance) * scale.asDiagonal();
  const Eigen::LLT<Eigen::Matrix3d> factor(correlation);
  if (factor.info() != Eigen::Success) return false;
  const Eigen::Matrix3d inverse = factor.solve(Eigen::Matrix3d::Identity());
  *information = scale.asDiagonal() * Symmetric(inverse) * scale.asDiagonal();
  return information->allFinite();
}

}  // namespace uncertainty
}  // namespace cartographer_ext
