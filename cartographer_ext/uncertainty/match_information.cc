// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/match_information.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartographer_ext {
namespace uncertainty {
namespace {

// `turn` is the share of rotation in an axis, 0 to 1.
double Floor(const MatchInformationOptions& options,
             const double largest_curvature, const double turn) {
  const double share =
      (1. - turn) * options.translation_floor + turn * options.rotation_floor;
  return std::max(options.floor, share * largest_curvature);
}

}  // namespace

double Belief(const double information, const double floor,
              const double full_ratio) {
  if (!(information > 0.) || information <= floor) return 0.;
  if (floor <= 0. || information >= full_ratio * floor) return 1.;
  const double t = std::log(information / floor) / std::log(full_ratio);
  return t * t * (3. - 2. * t);
}

MatchInformation EstimateMatchInformation(
    const MatchInformationOptions& options, const ScaledMotion& motion,
    const ScanCurvature& curvature, const int num_points) {
  if (num_points <= 0 || !curvature.values.allFinite() ||
      !curvature.rises.allFinite() || !motion.ToPose().allFinite() ||
      !motion.FromPose().allFinite()) {
    return NoMatchInformation();
  }
  MatchInformation match;
  match.axes = motion.ToPose() * curvature.axes;
  match.inverse_axes = curvature.axes.transpose() * motion.FromPose();
  match.curvature = curvature.values.cwiseMax(0.);
  const double noise = options.map_noise * options.map_noise +
                       options.point_noise * options.point_noise / num_points;
  const Eigen::Vector3d rises = curvature.rises.cwiseMax(0.);
  const double largest = rises.maxCoeff();
  Eigen::Vector3d information;  // per squared cell, without weights
  for (int k = 0; k < 3; ++k) {
    const double turn = curvature.axes(2, k) * curvature.axes(2, k);
    const double floor = Floor(options, largest, turn);
    match.weights(k) = Belief(rises(k), floor, options.full_ratio);
    information(k) = match.curvature(k) / noise;
    match.variances(k) = information(k) > 0.
                             ? 1. / information(k)
                             : std::numeric_limits<double>::infinity();
  }
  const auto in_pose = [&match](const Eigen::Vector3d& per_axis) {
    return Eigen::Matrix3d(match.inverse_axes.transpose() *
                           per_axis.asDiagonal() * match.inverse_axes);
  };
  match.information = in_pose(match.weights.cwiseProduct(information));
  match.rise_information = in_pose(rises / noise);
  const Eigen::Matrix3d& from_pose = motion.FromPose();
  match.translation_floor =
      Floor(options, largest, 0.) / noise * from_pose(0, 0) * from_pose(0, 0);
  match.rotation_floor =
      Floor(options, largest, 1.) / noise * from_pose(2, 2) * from_pose(2, 2);
  return match;
}

MatchInformation NoMatchInformation() {
  MatchInformation match;
  match.variances.setConstant(std::numeric_limits<double>::infinity());
  return match;
}

}  // namespace uncertainty
}  // namespace cartographer_ext
