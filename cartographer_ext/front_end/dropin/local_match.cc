// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/local_match.h"

#include "Eigen/Dense"
#include "cartographer_ext/common/planar_matrix.h"

namespace cartographer_ext {
namespace front_end {

using scan_matching::Prediction;

Prediction ToPrediction(const Pose2& last_pose, const Pose2& motion,
                        const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d rotation = PlanarRotation(last_pose.theta);
  Prediction prediction;
  prediction.pose = last_pose * motion;
  prediction.covariance = rotation * covariance * rotation.transpose();
  return prediction;
}

double ChiSquare(const Prediction& predicted, const Pose2& pose) {
  const Eigen::Vector3d off(pose.x - predicted.pose.x,
                            pose.y - predicted.pose.y,
                            NormalizeAngle(pose.theta - predicted.pose.theta));
  return off.dot(predicted.covariance.ldlt().solve(off));
}

}  // namespace front_end
}  // namespace cartographer_ext
