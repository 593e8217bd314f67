// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/wheels_at_rest.h"

#include "cartographer_ext/scan_matching/dropin/mean_score.h"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// In one recording of twenty the odometry is dead.
constexpr double kLogOddsOfDeadOdometry = 3.;

}  // namespace

LocalMatch UnlessAtRest(const Pose2& last_pose,
                        const MotionPrediction& prediction,
                        const LocalMatch& match,
                        const cartographer::sensor::PointCloud& cloud,
                        const cartographer::mapping::Grid2D& grid) {
  if (!prediction.wheels_never_moved) return match;
  const scan_matching::Prediction at_rest =
      ToPrediction(last_pose, prediction.motion, prediction.covariance);
  const scan_matching::PoseEvidence evidence(
      match.pose, cloud, grid, scan_matching::PosePrecision::kCell);
  if (evidence.AgainstWithoutObject(at_rest.pose) >= kLogOddsOfDeadOdometry) {
    return match;
  }
  LocalMatch result = match;
  result.pose = at_rest.pose;
  result.report.covariance = at_rest.covariance;
  result.report.scan_information.setZero();
  result.score = scan_matching::MeanScore(result.pose, cloud, grid);
  return result;
}

}  // namespace front_end
}  // namespace cartographer_ext
