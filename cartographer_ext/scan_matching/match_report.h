// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What goes into a scan match besides the scan, and what comes out of it
// besides the pose. All poses and matrices are of (map <- node), where map is
// the frame of the grid (local SLAM: the local frame): x and y in metres,
// theta in radians, in this order. A covariance is that of the errors
// (dx, dy, dtheta) added to the pose in the map frame.
#ifndef CARTOGRAPHER_EXT_SCAN_MATCHING_MATCH_REPORT_H_
#define CARTOGRAPHER_EXT_SCAN_MATCHING_MATCH_REPORT_H_

#include <limits>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/degeneracy.h"

namespace cartographer_ext {
namespace scan_matching {

// Where odometry, IMU or extrapolation put the node (X_0 of G eq. 19).
struct Prediction {
  Pose2 pose;
  // Symmetric and positive definite. One that is not finite or not positive
  // definite counts as "not known": the match uses the weights of the options.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // Number of scans in the map; 0 when it is not known. All walls of a map of a
  // single scan have the noise and the rounding of that scan.
  int scans_in_map = 0;
  // Metres from the node from which on points are where the laser's sight ends
  // and the map may not reach (occupied_space_cost.h).
  double limit_of_sight = std::numeric_limits<double>::infinity();
};

struct MatchReport {
  // What the scan alone determines, at the pose returned. With a TSDF, whose
  // match is the stock one, everything counts as determined.
  DegeneracyResult degeneracy;

  // Of the pose returned: scan and prediction together. Always finite and
  // positive definite; `information` is its inverse.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  // Of the scan alone, positive semi-definite: zero along what it does not
  // determine.
  Eigen::Matrix3d scan_information = Eigen::Matrix3d::Zero();

  // Half the sum of squared residuals, with the weights of the options, at the
  // initial pose and at the pose returned.
  double initial_cost = 0.;
  double final_cost = 0.;
  int iterations = 0;
  // False when the iterations ran out.
  bool converged = false;

  // X_s of G eq. 19: the solution before the directions that the scan does not
  // observe were taken from the prediction.
  Pose2 match;
  // The match minus the prediction, angle wrapped, along what the scan
  // determines; zero along the rest.
  Eigen::Vector3d disagreement = Eigen::Vector3d::Zero();
  // Squared Mahalanobis distance of the disagreement, under the covariances of
  // prediction and scan together; to be compared with chi2 of
  // `degrees_of_freedom` (the number of determined directions, 0 to 3). Zero
  // where the covariance of the prediction is not known.
  double mahalanobis = 0.;
  int degrees_of_freedom = 0;
};

}  // namespace scan_matching
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SCAN_MATCHING_MATCH_REPORT_H_
