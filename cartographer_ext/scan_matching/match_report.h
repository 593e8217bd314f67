// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs of a scan match besides the scan, and its results besides the pose.
// All poses and matrices are of (map <- node), where map is the frame of the
// grid (local SLAM: the local frame): x and y in metres, theta in radians, in
// this order. A covariance is that of the errors (dx, dy, dtheta) added to the
// pose in the map frame.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_MATCH_REPORT_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_MATCH_REPORT_H_

#include <limits>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/degeneracy.h"

namespace cartographer_ext {
namespace scan_matching {

// Pose of the node from odometry, IMU or extrapolation (X_0 of G eq. 19).
struct Prediction {
  Pose2 pose;
  // Symmetric and positive definite. A matrix that is not finite or not
  // positive definite means "unknown": the match then uses the weights of the
  // options.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // Number of scans in the map; 0: unknown. In a map of a single scan all walls
  // have the noise and quantisation of that scan.
  int scans_in_map = 0;
  // Distance from the node, metres, beyond which points are at the limit of the
  // laser's range, where the map may end (occupied_space_cost.h).
  double limit_of_sight = std::numeric_limits<double>::infinity();
};

// Results of a scan match besides the pose.
struct MatchReport {
  // Degeneracy of the scan alone, at the returned pose. With a TSDF, which is
  // matched by the stock matcher, nothing counts as degenerate.
  DegeneracyResult degeneracy;

  // Covariance of the returned pose, from scan and prediction. Always finite
  // and positive definite; `information` is its inverse.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  // Information of the scan alone, positive semi-definite: zero along
  // degenerate directions.
  Eigen::Matrix3d scan_information = Eigen::Matrix3d::Zero();

  // Half the sum of squared residuals, with the weights of the options, at the
  // initial pose and at the pose returned.
  double initial_cost = 0.;
  double final_cost = 0.;
  int iterations = 0;
  // False if the iteration limit was reached.
  bool converged = false;

  // X_s of G eq. 19: the solution before degenerate directions are replaced by
  // the prediction.
  Pose2 match;
  // The match minus the prediction, angle wrapped, along observable directions;
  // zero along the others.
  Eigen::Vector3d disagreement = Eigen::Vector3d::Zero();
  // Squared Mahalanobis distance of the disagreement, under the joint
  // covariance of prediction and scan; to be compared with chi2 of
  // `degrees_of_freedom` (the number of observable directions, 0 to 3). Zero if
  // the covariance of the prediction is unknown.
  double mahalanobis = 0.;
  int degrees_of_freedom = 0;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_MATCH_REPORT_H_
