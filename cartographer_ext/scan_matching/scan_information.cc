// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/scan_matching/scan_information.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Eigen/Cholesky"
#include "Eigen/Eigenvalues"
#include "Eigen/LU"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace scan_matching {
namespace {

// An axis with less belief is not compared with the prediction.
constexpr double kMinComparedWeight = 0.5;

Eigen::Vector3d Difference(const Pose2& pose, const Pose2& from) {
  return Eigen::Vector3d(pose.x - from.x, pose.y - from.y,
                         NormalizeAngle(pose.theta - from.theta));
}

Pose2 Add(const Pose2& pose, const Eigen::Vector3d& difference) {
  return Pose2(pose.x + difference.x(), pose.y + difference.y(),
               NormalizeAngle(pose.theta + difference.z()));
}

// `turn` is the share of rotation in an axis, 0 to 1.
double Floor(const ScanInformationOptions& options,
             const double largest_curvature, const double turn) {
  const double share =
      (1. - turn) * options.translation_floor + turn * options.rotation_floor;
  return std::max(options.floor, share * largest_curvature);
}

}  // namespace

ScanInformation AnalyzeScan(const ScanInformationOptions& options,
                            const ScaledMotion& motion,
                            const ScanCurvature& curvature,
                            const int num_points,
                            const Eigen::Matrix3d& gauss_newton) {
  if (num_points <= 0 || !curvature.values.allFinite() ||
      !curvature.rises.allFinite() || !motion.ToPose().allFinite() ||
      !motion.FromPose().allFinite()) {
    return NoInformation();
  }
  ScanInformation scan;
  scan.axes = motion.ToPose() * curvature.axes;
  scan.inverse_axes = curvature.axes.transpose() * motion.FromPose();
  scan.curvature = curvature.values.cwiseMax(0.);
  const double noise = options.map_noise * options.map_noise +
                       options.point_noise * options.point_noise / num_points;
  const Eigen::Vector3d rises = curvature.rises.cwiseMax(0.);
  const double largest = rises.maxCoeff();
  Eigen::Vector3d information;  // per squared cell, whether believed or not
  for (int k = 0; k < 3; ++k) {
    const double turn = curvature.axes(2, k) * curvature.axes(2, k);
    const double floor = Floor(options, largest, turn);
    scan.weights(k) = Belief(rises(k), floor, options.full_ratio);
    information(k) = scan.curvature(k) / noise;
    scan.variances(k) = information(k) > 0.
                            ? 1. / information(k)
                            : std::numeric_limits<double>::infinity();
  }
  const auto in_pose = [&scan](const Eigen::Vector3d& per_axis) {
    return Eigen::Matrix3d(scan.inverse_axes.transpose() *
                           per_axis.asDiagonal() * scan.inverse_axes);
  };
  scan.information = in_pose(scan.weights.cwiseProduct(information));

  DegeneracyOptions degeneracy;
  degeneracy.mode = options.mode;
  degeneracy.full_ratio = options.full_ratio;
  degeneracy.paper_ratio = options.paper_ratio;
  const Eigen::Matrix3d& from_pose = motion.FromPose();
  degeneracy.translation_floor =
      Floor(options, largest, 0.) / noise * from_pose(0, 0) * from_pose(0, 0);
  degeneracy.rotation_floor =
      Floor(options, largest, 1.) / noise * from_pose(2, 2) * from_pose(2, 2);
  const Eigen::Matrix3d by_rises = in_pose(rises / noise);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> given_heading(
      Eigen::Matrix2d(by_rises.topLeftCorner<2, 2>()));
  scan.directions = given_heading.eigenvectors();
  for (int i = 0; i < 2; ++i) {
    scan.direction_weights(i) =
        Belief(given_heading.eigenvalues()(i), degeneracy.translation_floor,
               options.full_ratio);
  }
  scan.degeneracy = AnalyzeDegeneracy(
      degeneracy,
      options.mode == DegeneracyMode::kPaperLiteral ? gauss_newton : by_rises);
  return scan;
}

ScanInformation NoInformation() {
  ScanInformation scan;
  scan.variances.setConstant(std::numeric_limits<double>::infinity());
  scan.degeneracy =
      AnalyzeDegeneracy(DegeneracyOptions(), Eigen::Matrix3d::Zero());
  return scan;
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

Pose2 Remap(const ScanInformation& scan, const DegeneracyMode mode,
            const Pose2& prediction, const Pose2& match) {
  if (mode == DegeneracyMode::kPaperLiteral) {
    return RemapSolution(scan.degeneracy, prediction, match);
  }
  if (scan.direction_weights.minCoeff() >= 1.) return match;
  const Eigen::Vector2d difference =
      match.translation() - prediction.translation();
  const Eigen::Vector2d accepted =
      scan.directions * scan.direction_weights.cwiseProduct(
                            scan.directions.transpose() * difference);
  return Pose2(prediction.x + accepted.x(), prediction.y + accepted.y(),
               match.theta);
}

Pose2 Fuse(const ScanInformation& scan, const Pose2& prediction,
           const Eigen::Matrix3d& prior, const Pose2& match) {
  // In cells along the axes all entries are of one order of magnitude.
  const Eigen::Matrix3d information =
      scan.axes.transpose() * scan.information * scan.axes;
  const Eigen::Matrix3d both =
      information + scan.axes.transpose() * prior * scan.axes;
  const Eigen::Vector3d along = both.ldlt().solve(
      information * (scan.inverse_axes * Difference(match, prediction)));
  if (!along.allFinite()) return prediction;
  return Add(prediction, scan.axes * along);
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
    if (scan.weights(k) >= kMinComparedWeight) {
      ++report->degrees_of_freedom;
      scatter(k, k) += scan.variances(k);
    } else {
      // Left out: decoupled from the others, with nothing to say.
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
