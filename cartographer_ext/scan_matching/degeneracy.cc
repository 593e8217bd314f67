// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/degeneracy.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Eigenvalues"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/match_information.h"

namespace cartographer_ext {
namespace scan_matching {

DegeneracyResult AnalyzeDegeneracy(const DegeneracyOptions& options,
                                   const Eigen::Matrix3d& hessian) {
  DegeneracyResult result;
  const Eigen::Matrix3d h = hessian.allFinite()
                                ? Symmetric(hessian)
                                : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  const Eigen::Matrix2d a = h.topLeftCorner<2, 2>();
  const Eigen::Vector2d b = h.topRightCorner<2, 1>();
  const double c = h(2, 2);

  // Schur complements: translation without rotation and the reverse.
  Eigen::Matrix2d translation = a;
  if (c > 0.) translation -= b * b.transpose() / c;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(translation);
  result.eigenvalues = solver.eigenvalues().cwiseMax(0.);
  result.eigenvectors = solver.eigenvectors();
  // What is below the floor explains nothing away.
  result.rotation_information = c;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> of_a(a);
  const double smallest =
      std::max(options.translation_floor, 1e-12 * of_a.eigenvalues()(1));
  for (int i = 0; i < 2; ++i) {
    if (!(of_a.eigenvalues()(i) > smallest)) continue;
    const double projection = of_a.eigenvectors().col(i).dot(b);
    result.rotation_information -=
        projection * projection / of_a.eigenvalues()(i);
  }
  result.rotation_information = std::max(0., result.rotation_information);

  const Eigen::Vector2d weakest = result.eigenvectors.col(0);
  result.direction = std::atan2(weakest.y(), weakest.x());
  if (result.direction < 0.) result.direction += kPi;
  if (result.direction >= kPi) result.direction -= kPi;
  result.ratio = result.eigenvalues(1) > 0.
                     ? result.eigenvalues(0) / result.eigenvalues(1)
                     : 0.;

  switch (options.mode) {
    case DegeneracyMode::kNoiseFloor: {
      for (int i = 0; i < 2; ++i) {
        result.translation_weights(i) =
            uncertainty::Belief(result.eigenvalues(i),
                                options.translation_floor, options.full_ratio);
      }
      result.rotation_weight =
          uncertainty::Belief(result.rotation_information,
                              options.rotation_floor, options.full_ratio);
      break;
    }
    case DegeneracyMode::kPaperLiteral:
      // Eigenvalues of the covariance are the inverse ones.
      result.translation_weights(1) = result.eigenvalues(1) > 0. ? 1. : 0.;
      result.translation_weights(0) =
          result.eigenvalues(0) * options.paper_ratio > result.eigenvalues(1)
              ? 1.
              : 0.;
      result.rotation_weight = 1.;
      break;
  }

  const bool first = result.translation_weights(0) < 0.5;
  const bool second = result.translation_weights(1) < 0.5;
  const bool rotation = result.rotation_weight < 0.5;
  if (first && second) {
    result.state =
        rotation ? DegeneracyState::kEverything : DegeneracyState::kPosition;
  } else if (first || second) {
    result.state = rotation ? DegeneracyState::kTranslationAndRotation
                            : DegeneracyState::kTranslation;
  } else {
    result.state =
        rotation ? DegeneracyState::kRotation : DegeneracyState::kNone;
  }
  return result;
}

}  // namespace scan_matching
}  // namespace cartographer_ext
