// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/matched_motion.h"

#include <cmath>

#include "Eigen/Core"
#include "Eigen/Dense"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/scan_matching/match_report.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::PointCloud;

// A direction of translation, or rotation, with a lower weight in the match is
// not observable in the scan.
constexpr double kMinObservableWeight = 0.5;

// Whether the scan determines the translation along the direction of motion.
bool IsTranslationObservable(const scan_matching::DegeneracyResult& degeneracy,
                             const Pose2& from, const Pose2& to) {
  const Eigen::Vector2d translation(to.x - from.x, to.y - from.y);
  const double length = translation.norm();
  const Eigen::Vector2d heading =
      length > 0.01 ? Eigen::Vector2d(translation / length)
                    : Eigen::Vector2d(std::cos(to.theta), std::sin(to.theta));
  double weight = 0.;
  for (int i = 0; i < 2; ++i) {
    const double along = degeneracy.eigenvectors.col(i).dot(heading);
    weight += along * along * degeneracy.translation_weights(i);
  }
  return weight > kMinObservableWeight;
}

// A covariance from the local frame into that of the robot at `pose`.
Eigen::Matrix3d InFrameOf(const Pose2& pose,
                          const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d rotation = PlanarRotation(pose.theta);
  return rotation.transpose() * covariance * rotation;
}

// Of the heading by the scan alone, radians. Without the scan a metre and a radian
// are unknown, so that there is always a covariance.
double ScanHeadingSigma(const scan_matching::MatchReport& report) {
  const Eigen::Matrix3d information =
      report.scan_information + Eigen::Matrix3d::Identity();
  return std::sqrt(information.inverse()(2, 2));
}

double MeanRange(const PointCloud& cloud) {
  double sum = 0.;
  for (const auto& point : cloud) sum += point.position.head<2>().norm();
  return cloud.empty() ? 0. : sum / static_cast<double>(cloud.size());
}

}  // namespace

MatchedMotion ToMatchedMotion(const Pose2& last_pose,
                              const MotionPrediction& prediction,
                              const LocalMatch& match,
                              const PointCloud& cloud) {
  MatchedMotion matched;
  matched.motion = Between(last_pose, match.pose);
  matched.translation_observable =
      IsTranslationObservable(match.report.degeneracy, last_pose, match.pose);
  matched.rotation_observable =
      match.report.degeneracy.rotation_weight > kMinObservableWeight;
  matched.covariance = InFrameOf(last_pose, match.report.covariance);
  matched.scan_heading =
      NormalizeAngle(match.report.match.theta - match.pose.theta);
  matched.scan_heading_sigma = ScanHeadingSigma(match.report);
  matched.mean_range = MeanRange(cloud);
  matched.from_velocity =
      (prediction.source == PredictionSource::kConstantVelocity ||
       prediction.source == PredictionSource::kImu) &&
      !match.relocated;
  matched.overrules_odometry = match.overrules_odometry;
  matched.ends_contest = match.ends_contest;
  matched.rival_motion = match.rival_motion;
  return matched;
}

MatchInnovation InnovationOf(const Pose2& last_pose,
                             const MotionPrediction& prediction,
                             const LocalMatch& match, const double gate) {
  MatchInnovation innovation;
  const scan_matching::DegeneracyResult& degeneracy = match.report.degeneracy;
  if (prediction.source != PredictionSource::kOdometry ||
      prediction.is_uncertain ||
      (match.searched && match.report.mahalanobis > gate)) {
    return innovation;
  }
  const scan_matching::Prediction predicted =
      ToPrediction(last_pose, prediction.motion, prediction.covariance);
  const Pose2& by_scan = match.report.match;
  if (degeneracy.translation_weights(1) >= 1. &&
      degeneracy.eigenvalues(1) > 0.) {
    const Eigen::Vector2d direction = degeneracy.eigenvectors.col(1);
    innovation.along.squared = Squared(
        direction.dot(by_scan.translation() - predicted.pose.translation()));
    innovation.along.match_variance = 1. / degeneracy.eigenvalues(1);
    innovation.along.prediction_variance =
        direction.dot(predicted.covariance.topLeftCorner<2, 2>() * direction);
  }
  if (degeneracy.rotation_weight >= 1. && prediction.heading_by_wheels) {
    innovation.heading.squared =
        Squared(NormalizeAngle(by_scan.theta - predicted.pose.theta));
    innovation.heading.match_variance = Squared(ScanHeadingSigma(match.report));
    innovation.heading.prediction_variance = predicted.covariance(2, 2);
  }
  return innovation;
}

}  // namespace front_end
}  // namespace cartographer_ext
