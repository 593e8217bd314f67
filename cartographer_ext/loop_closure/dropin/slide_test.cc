// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/slide_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Eigen/Eigenvalues"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Metres. Shorter slides do little harm, longer ones leave the wall when its
// direction is not known exactly.
constexpr double kSlides[] = {-1., -0.5, 0.5, 1.};
// Directions with more than this share of the information of the best one are
// determined.
constexpr double kDetermined = 0.1;

}  // namespace

double SlideOdds(const Pose2& pose, const Eigen::Matrix3d& information,
                 const absl::optional<PredictedPosition>& predicted,
                 const cartographer::sensor::PointCloud& cloud,
                 const cartographer::mapping::Grid2D& grid) {
  double odds = std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> translation(
      Eigen::Matrix2d(information.topLeftCorner<2, 2>()));
  if (!information.allFinite() ||
      translation.eigenvalues()(0) >
          kDetermined * translation.eigenvalues()(1)) {
    return odds;
  }
  const Eigen::Vector2d direction = translation.eigenvectors().col(0);
  const scan_matching::PoseEvidence evidence(
      pose, cloud, grid, scan_matching::PosePrecision::kExact);
  for (const double slide : kSlides) {
    const Eigen::Vector2d moved = pose.translation() + slide * direction;
    double against = evidence.Against(Pose2(moved.x(), moved.y(), pose.theta));
    if (predicted.has_value()) {
      against += 0.5 *
                 ((moved - predicted->position).squaredNorm() -
                  (pose.translation() - predicted->position).squaredNorm()) /
                 (predicted->sigma * predicted->sigma);
    }
    odds = std::min(odds, against);
  }
  return odds;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
