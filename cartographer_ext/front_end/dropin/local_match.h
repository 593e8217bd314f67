// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCH_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCH_H_

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/scan_matching/match_report.h"

namespace cartographer_ext {
namespace front_end {

// The result of a match of local SLAM.
struct LocalMatch {
  Pose2 pose;  // (local <- robot)
  scan_matching::MatchReport report;
  // Mean probability under the points, 0 to 1.
  double score = 0.;
  // Probability that it is wrong, by the score.
  double doubt = 0.;
  bool searched = false;
  // The result comes from the search.
  bool relocated = false;
  // It, or one since which none agreed, contradicted the odometry, and the scans
  // were evidence enough.
  bool overrules_odometry = false;
  // It makes up for several scans at contested poses.
  bool ends_contest = false;
  // Then the motion of the rival since the last scan; (last robot <- robot).
  Pose2 rival_motion;
  // The pose is that of the odometry, or agrees with it, but fits badly, and
  // another one that the odometry contradicts fits better: the scan should not
  // go into the map.
  bool contested = false;
};

// Of a motion from `last_pose`, (local <- robot), with its covariance in the
// frame of the robot there: in the local frame.
scan_matching::Prediction ToPrediction(const Pose2& last_pose,
                                       const Pose2& motion,
                                       const Eigen::Matrix3d& covariance);

// chi2 of a pose by a prediction, whatever the scan determines of it: along a
// corridor a match is consistent with its prediction wherever it ends.
double ChiSquare(const scan_matching::Prediction& predicted, const Pose2& pose);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_LOCAL_MATCH_H_
