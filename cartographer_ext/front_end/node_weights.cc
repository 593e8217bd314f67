// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/node_weights.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Eigenvalues"
#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Nothing is known better than this, metres and radians.
constexpr double kSmallestSigma = 1e-5;
// Nor worse: where a motion is not known at all.
constexpr double kLargestSigma = 1e3;

}  // namespace

Eigen::Vector2d TwoSigmas(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> translation(
      Eigen::Matrix2d(Symmetric(covariance).topLeftCorner<2, 2>()));
  return Eigen::Vector2d(std::sqrt(std::max(0., translation.eigenvalues()(1))),
                         std::sqrt(std::max(0., covariance(2, 2))));
}

Eigen::Matrix3d RelativeInformation(const NodeWeightOptions& options,
                                    const Eigen::Matrix3d& covariance) {
  const auto ratio = [&options](const double variance) {
    return variance > 1. ? std::max(options.min_ratio, 1. / variance) : 1.;
  };
  if (!covariance.allFinite()) {
    return options.min_ratio * Eigen::Matrix3d::Identity();
  }
  const Eigen::Vector3d scale(1. / options.translation_sigma,
                              1. / options.translation_sigma,
                              1. / options.rotation_sigma);
  const Eigen::Matrix3d scaled =
      scale.asDiagonal() * Symmetric(covariance) * scale.asDiagonal();
  if (options.form == NodeWeightForm::kTwoScalars) {
    const Eigen::Vector2d sigmas = TwoSigmas(scaled);
    const double way = ratio(sigmas(0) * sigmas(0));
    return Eigen::Vector3d(way, way, ratio(sigmas(1) * sigmas(1))).asDiagonal();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scaled);
  if (eigen.info() != Eigen::Success) {
    return options.min_ratio * Eigen::Matrix3d::Identity();
  }
  const Eigen::Vector3d ratios = eigen.eigenvalues().unaryExpr(ratio);
  return Symmetric(eigen.eigenvectors() * ratios.asDiagonal() *
                   eigen.eigenvectors().transpose());
}

void ScanUncertainty::Add(const Eigen::Matrix3d& motion,
                          const Eigen::Matrix3d& scan) {
  Eigen::Matrix3d predicted = kept_;
  predicted.diagonal().array() += kSmallestSigma * kSmallestSigma;
  if (motion.allFinite()) {
    predicted += motion;
  } else {
    predicted.diagonal().array() += kLargestSigma * kLargestSigma;
  }
  newest_ = Symmetric(predicted);
  if (!scan.allFinite()) return;
  // (P^-1 + L)^-1 = P (I + L P)^-1 needs no inverse of a P that is nearly
  // singular.
  const Eigen::Matrix3d matched = Symmetric(
      predicted *
      (Eigen::Matrix3d::Identity() + Symmetric(scan) * predicted).inverse());
  if (matched.allFinite() && matched.diagonal().minCoeff() > 0.) {
    newest_ = matched;
  }
}

}  // namespace front_end
}  // namespace cartographer_ext
