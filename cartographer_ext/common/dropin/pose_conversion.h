// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Conversion between Pose2 and the host's rigid transforms.
#ifndef CARTOGRAPHER_EXT_COMMON_DROPIN_POSE_CONVERSION_H_
#define CARTOGRAPHER_EXT_COMMON_DROPIN_POSE_CONVERSION_H_

#include "Eigen/Core"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {

// The heading in [-pi, pi].
inline Pose2 ToPose2(const cartographer::transform::Rigid2d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               pose.normalized_angle());
}

// Keeps the heading as it is stored, without wrapping: a matcher returns its
// result within half a turn of the initial pose.
inline Pose2 ToUnwrappedPose2(const cartographer::transform::Rigid2d& pose) {
  return Pose2(pose.translation().x(), pose.translation().y(),
               pose.rotation().angle());
}

// x, y and yaw.
inline Pose2 ToPose2(const cartographer::transform::Rigid3d& pose) {
  return ToPose2(cartographer::transform::Project2D(pose));
}

// Keeps the heading as it is.
inline cartographer::transform::Rigid2d ToRigid2d(const Pose2& pose) {
  return cartographer::transform::Rigid2d(pose.translation(), pose.theta);
}

}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_COMMON_DROPIN_POSE_CONVERSION_H_
