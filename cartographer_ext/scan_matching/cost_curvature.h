// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_COST_CURVATURE_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_COST_CURVATURE_H_

#include "Eigen/Core"
#include "cartographer_ext/scan_matching/occupied_space_cost.h"
#include "cartographer_ext/uncertainty/scan_curvature.h"

namespace cartographer_ext {
namespace scan_matching {

// The curvature of the mean cost of a scan around the pose of `motion`.
// `hessian`, about (x, y, theta), is any symmetric matrix with similar axes;
// `step` in cells, > 0. The scan must not be empty.
template <typename Cells>
uncertainty::ScanCurvature MeasureCurvature(
    const OccupiedSpaceCost<Cells>& cost,
    const uncertainty::ScaledMotion& motion, const Eigen::Matrix3d& hessian,
    const double step) {
  const double per_point = 0.5 / static_cast<double>(cost.points().size());
  return uncertainty::MeasureCurvature(
      [&](const Eigen::Vector3d& scaled) {
        return per_point * cost.LinearSquares(motion.Moved(scaled));
      },
      motion.ToPose().transpose() * hessian * motion.ToPose(), step);
}

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_COST_CURVATURE_H_
