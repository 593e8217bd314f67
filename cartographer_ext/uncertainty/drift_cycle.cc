// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_cycle.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

Eigen::Vector3d ErrorOf(const Pose2& cycle) {
  return Eigen::Vector3d(cycle.x, cycle.y, NormalizeAngle(cycle.theta));
}

Eigen::Matrix3d Moved(const Eigen::Matrix3d& covariance, const Pose2& pose) {
  const Eigen::Matrix3d adjoint = Adjoint(pose);
  return adjoint * covariance * adjoint.transpose();
}

// Takes the error of a cycle out of the effects of turning and scale, see the head
// of the file.
void RemoveOwnError(DriftCycle* const cycle) {
  cycle->parts.common(2, 1) -= cycle->error.z();
  cycle->parts.common.col(2).head<2>() -= cycle->error.head<2>();
}

}  // namespace

DriftCycle CycleOfLoops(const UncertainPose& loop_u, const DriftStretch& path_b,
                        const UncertainPose& loop_v,
                        const DriftStretch& path_a) {
  const UncertainPose back = Invert(loop_v);
  DriftCycle cycle;
  cycle.error = ErrorOf(loop_u.pose * path_b.pose * back.pose * path_a.pose);
  // What is right of each edge moves its error to the end of the cycle.
  const Pose2 right_of_back = path_a.pose;
  const Pose2 right_of_b = back.pose * right_of_back;
  const Pose2 right_of_u = path_b.pose * right_of_b;
  cycle.parts = Transported(path_b.parts, Adjoint(right_of_b.Inverse()));
  cycle.parts += path_a.parts;
  cycle.parts.other += Moved(loop_u.covariance, right_of_u.Inverse()) +
                       Moved(back.covariance, right_of_back.Inverse());
  RemoveOwnError(&cycle);
  return cycle;
}

DriftCycle CycleOfLoop(const UncertainPose& loop, const DriftStretch& path) {
  DriftCycle cycle;
  cycle.error = ErrorOf(loop.pose * path.pose);
  cycle.parts = path.parts;
  cycle.parts.other += Moved(loop.covariance, path.pose.Inverse());
  RemoveOwnError(&cycle);
  return cycle;
}

HeadingCycle HeadingOfLoop(const UncertainPose& loop,
                           const DriftStretch& path) {
  const DriftCycle cycle = CycleOfLoop(loop, path);
  HeadingCycle heading;
  heading.error = cycle.error.z();
  heading.rotation = cycle.parts.rotation(2, 2);
  heading.turning = cycle.parts.turning(2, 2);
  heading.other = cycle.parts.other(2, 2);
  heading.common = cycle.parts.common.row(2);
  return heading;
}

}  // namespace uncertainty
}  // namespace cartographer_ext
