// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/wheels_at_rest.h"

#include <algorithm>
#include <cmath>

#include "Eigen/Core"
#include "cartographer_ext/scan_matching/dropin/mean_score.h"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using scan_matching::PoseEvidence;
using scan_matching::PosePrecision;

// In one recording of twenty the odometry is dead.
constexpr double kLogOddsOfDeadOdometry = 3.;
// The best of the places within a cell, some 150, fits better by chance.
constexpr double kLogPlaces = 5.;

// Root mean square, metres, of how far the points of the cloud are moved.
double MovesPoints(const Pose2& motion,
                   const cartographer::sensor::PointCloud& cloud) {
  double squares = 0.;
  for (const auto& point : cloud) {
    const Eigen::Vector2d p = point.position.head<2>().cast<double>();
    squares += (motion * p - p).squaredNorm();
  }
  return std::sqrt(squares / std::max<size_t>(1, cloud.size()));
}

// Whether the scan shows without one object that the robot is not at `rest`: by more
// than a cell, or, where it sees much, by less. Wheels may be late.
bool HasMoved(const Pose2& pose, const Pose2& rest,
              const cartographer::sensor::PointCloud& cloud,
              const cartographer::mapping::Grid2D& grid) {
  return PoseEvidence(pose, cloud, grid, PosePrecision::kCell)
                 .AgainstWithoutObject(rest) >= kLogOddsOfDeadOdometry ||
         PoseEvidence(pose, cloud, grid, PosePrecision::kExact)
                 .AgainstWithoutObject(rest) >=
             kLogOddsOfDeadOdometry + kLogPlaces;
}

}  // namespace

LocalMatch UnlessAtRest(const Pose2& last_pose,
                        const MotionPrediction& prediction,
                        const LocalMatch& match,
                        const cartographer::sensor::PointCloud& cloud,
                        const cartographer::mapping::Grid2D& grid) {
  if (!prediction.wheels_never_moved) return match;
  const scan_matching::Prediction at_rest =
      ToPrediction(last_pose, prediction.motion, prediction.covariance);
  // Less is the noise of matches, which need not be held.
  if (MovesPoints(Between(at_rest.pose, match.pose), cloud) <=
          0.5 * grid.limits().resolution() ||
      HasMoved(match.pose, at_rest.pose, cloud, grid)) {
    return match;
  }
  LocalMatch result = match;
  result.at_rest = true;
  result.pose = at_rest.pose;
  result.report.covariance = at_rest.covariance;
  result.report.scan_information.setZero();
  result.score = scan_matching::MeanScore(result.pose, cloud, grid);
  return result;
}

}  // namespace front_end
}  // namespace cartographer_ext
