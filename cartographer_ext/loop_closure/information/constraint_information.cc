// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/information/constraint_information.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Cholesky"
#include "Eigen/Eigenvalues"
#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace loop_closure {

ConstraintWeights ConfidenceWeights(const ConfidenceWeightOptions& options,
                                    const ConstraintWeights& stock,
                                    const double final_score) {
  const double ratio =
      std::max(final_score, options.minimum_score) / options.reference_score;
  ConstraintWeights weights;
  weights.translation =
      stock.translation * std::pow(ratio, 0.5 * options.alpha);
  weights.rotation = stock.rotation * std::pow(ratio, 0.5 * options.beta);
  return weights;
}

Eigen::Matrix3d PaperInformation(const double final_score, const double alpha,
                                 const double beta, const double angle) {
  const Eigen::Matrix3d u = PlanarRotation(angle);
  const Eigen::Vector3d diagonal(std::pow(final_score, alpha),
                                 std::pow(final_score, alpha),
                                 std::pow(final_score, beta));
  return u.transpose() * diagonal.asDiagonal() * u;  // C eq. 11, U^-1 = U^T
}

Eigen::Matrix3d FullInformation(const ConstraintWeights& weights,
                                const Eigen::Matrix3d& certain_covariance,
                                const Eigen::Matrix3d& match_covariance) {
  const Eigen::LLT<Eigen::Matrix3d> factor(match_covariance);
  if (!match_covariance.allFinite() || factor.info() != Eigen::Success) {
    return Eigen::Matrix3d::Zero();
  }
  const Eigen::Vector3d scale =
      certain_covariance.diagonal().cwiseSqrt().cwiseProduct(Eigen::Vector3d(
          weights.translation, weights.translation, weights.rotation));
  const Eigen::Matrix3d information =
      scale.asDiagonal() * factor.solve(Eigen::Matrix3d::Identity()) *
      scale.asDiagonal();
  return Symmetric(information);
}

ConstraintWeights ScalarWeights(const Eigen::Matrix3d& information) {
  ConstraintWeights weights;
  const Eigen::Matrix3d h = Symmetric(information);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> whole(h);
  if (!h.allFinite() ||
      whole.eigenvalues()(0) < -1e-9 * std::abs(whole.eigenvalues()(2))) {
    return weights;
  }
  Eigen::Matrix2d translation = h.topLeftCorner<2, 2>();
  const Eigen::Vector2d cross = h.topRightCorner<2, 1>();
  if (h(2, 2) > 0.) translation -= cross * cross.transpose() / h(2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> block(translation);
  weights.translation = std::sqrt(std::max(0., block.eigenvalues()(0)));

  // Schur complement of the translation block; its pseudo-inverse handles
  // directions without information.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> translation_only(
      Eigen::Matrix2d(h.topLeftCorner<2, 2>()));
  double rotation = h(2, 2);
  for (int i = 0; i < 2; ++i) {
    const double eigenvalue = translation_only.eigenvalues()(i);
    if (eigenvalue <= 1e-12 * std::abs(translation_only.eigenvalues()(1))) {
      continue;
    }
    const double projection = translation_only.eigenvectors().col(i).dot(cross);
    rotation -= projection * projection / eigenvalue;
  }
  weights.rotation = std::sqrt(std::max(0., rotation));
  return weights;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
