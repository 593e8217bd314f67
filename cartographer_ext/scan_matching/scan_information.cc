// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/scan_information.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Cholesky"
#include "Eigen/Eigenvalues"

namespace cartographer_ext {
namespace scan_matching {
namespace {

Eigen::Vector3d Difference(const Pose2& pose, const Pose2& from) {
  return Eigen::Vector3d(pose.x - from.x, pose.y - from.y,
                         NormalizeAngle(pose.theta - from.theta));
}

// K (X_s - X_0) by directions of translation; the heading is that of the match.
Eigen::Vector3d GainByDirections(const Eigen::Matrix2d& directions,
                                 const Eigen::Vector2d& weights,
                                 const Eigen::Vector3d& difference) {
  if (weights.minCoeff() >= 1.) return difference;
  Eigen::Vector3d correction = difference;
  correction.head<2>() =
      directions *
      weights.cwiseProduct(directions.transpose() * difference.head<2>());
  return correction;
}

// K (X_s - X_0) by the information of both.
Eigen::Vector3d GainByInformation(const ScanInformation& scan,
                                  const Eigen::Matrix3d& prior,
                                  const Eigen::Vector3d& difference) {
  // In units of cells all entries are of the same order of magnitude.
  const Eigen::Matrix3d information =
      scan.axes.transpose() * scan.information * scan.axes;
  const Eigen::Matrix3d both =
      information + scan.axes.transpose() * prior * scan.axes;
  const Eigen::Vector3d along =
      both.ldlt().solve(information * (scan.inverse_axes * difference));
  if (!along.allFinite()) return Eigen::Vector3d::Zero();
  return scan.axes * along;
}

}  // namespace

ScanInformation AnalyzeScan(const ScanInformationOptions& options,
                            const uncertainty::ScaledMotion& motion,
                            const uncertainty::ScanCurvature& curvature,
                            const int num_points,
                            const Eigen::Matrix3d& gauss_newton) {
  ScanInformation scan;
  scan.mode = options.mode;
  static_cast<uncertainty::MatchInformation&>(scan) =
      uncertainty::EstimateMatchInformation(options, motion, curvature,
                                            num_points);
  DegeneracyOptions degeneracy;
  degeneracy.mode = options.mode;
  degeneracy.full_ratio = options.full_ratio;
  degeneracy.paper_ratio = options.paper_ratio;
  degeneracy.translation_floor = scan.translation_floor;
  degeneracy.rotation_floor = scan.rotation_floor;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> given_heading(
      Eigen::Matrix2d(scan.rise_information.topLeftCorner<2, 2>()));
  scan.directions = given_heading.eigenvectors();
  for (int i = 0; i < 2; ++i) {
    scan.direction_weights(i) =
        uncertainty::Belief(given_heading.eigenvalues()(i),
                            degeneracy.translation_floor, options.full_ratio);
  }
  scan.degeneracy = AnalyzeDegeneracy(
      degeneracy, options.mode == DegeneracyMode::kPaperLiteral
                      ? gauss_newton
                      : scan.rise_information);
  return scan;
}

ScanInformation NoInformation() {
  ScanInformation scan;
  static_cast<uncertainty::MatchInformation&>(scan) =
      uncertainty::NoMatchInformation();
  scan.degeneracy =
      AnalyzeDegeneracy(DegeneracyOptions(), Eigen::Matrix3d::Zero());
  return scan;
}

Pose2 Remap(const ScanInformation& scan, const Eigen::Matrix3d* const prior,
            const Pose2& prediction, const Pose2& match) {
  const Eigen::Vector3d difference = Difference(match, prediction);
  Eigen::Vector3d correction;
  if (scan.mode == DegeneracyMode::kPaperLiteral) {
    correction =
        GainByDirections(scan.degeneracy.eigenvectors,
                         scan.degeneracy.translation_weights, difference);
  } else if (prior != nullptr) {
    correction = GainByInformation(scan, *prior, difference);
  } else {
    correction =
        GainByDirections(scan.directions, scan.direction_weights, difference);
  }
  // A match that is used as a whole is not changed by rounding.
  if (correction == difference) return match;
  return Pose2(prediction.x + correction.x(), prediction.y + correction.y(),
               correction.z() == difference.z()
                   ? match.theta
                   : NormalizeAngle(prediction.theta + correction.z()));
}

void Compare(const ScanInformation& scan, const Pose2& prediction,
             const Eigen::Matrix3d* const covariance, const Pose2& match,
             MatchReport* const report) {
  Eigen::Vector3d along = scan.inverse_axes * Difference(match, prediction);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Identity();
  if (covariance != nullptr) {
    scatter = scan.inverse_axes * *covariance * scan.inverse_axes.transpose();
  }
  report->degrees_of_freedom = 0;
  for (int k = 0; k < 3; ++k) {
    if (scan.weights(k) > 0.) {
      // Its share in the result is that of its weighted information, so it is
      // compared with that.
      ++report->degrees_of_freedom;
      scatter(k, k) += scan.variances(k) / scan.weights(k);
    } else {
      // This direction is decoupled from the others and has no residual.
      along(k) = 0.;
      scatter.row(k).setZero();
      scatter.col(k).setZero();
      scatter(k, k) = 1.;
    }
  }
  report->disagreement = scan.axes * along;
  report->mahalanobis = 0.;
  if (covariance != nullptr && report->degrees_of_freedom > 0) {
    const double distance = along.dot(scatter.ldlt().solve(along));
    if (std::isfinite(distance)) report->mahalanobis = std::max(0., distance);
  }
}

}  // namespace scan_matching
}  // namespace cartographer_ext
