// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/cycle_consistency.h"

#include <cmath>
#include <limits>

#include "Eigen/Cholesky"

namespace cartographer_ext {
namespace loop_closure {

Eigen::Matrix3d Adjoint(const Pose2& pose) {
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  Eigen::Matrix3d adjoint;
  adjoint << c, -s, pose.y, s, c, -pose.x, 0., 0., 1.;
  return adjoint;
}

UncertainPose Compose(const UncertainPose& lhs, const UncertainPose& rhs) {
  UncertainPose result;
  result.pose = lhs.pose * rhs.pose;
  const Eigen::Matrix3d transport = Adjoint(rhs.pose.Inverse());
  result.covariance =
      transport * lhs.covariance * transport.transpose() + rhs.covariance;
  return result;
}

UncertainPose Invert(const UncertainPose& pose) {
  UncertainPose result;
  result.pose = pose.pose.Inverse();
  const Eigen::Matrix3d transport = Adjoint(pose.pose);
  result.covariance = transport * pose.covariance * transport.transpose();
  return result;
}

CycleResult TestCycle(const CycleConsistencyOptions& options,
                      const UncertainPose& loop_u, const UncertainPose& path_b,
                      const UncertainPose& loop_v,
                      const UncertainPose& path_a) {
  const UncertainPose cycle =
      Compose(Compose(Compose(loop_u, path_b), Invert(loop_v)), path_a);
  CycleResult result;
  result.error = cycle.pose;
  result.covariance = cycle.covariance;
  const Eigen::Vector3d error(cycle.pose.x, cycle.pose.y,
                              NormalizeAngle(cycle.pose.theta));
  const Eigen::LLT<Eigen::Matrix3d> factor(cycle.covariance);
  if (factor.info() == Eigen::Success) {
    result.chi_square = error.dot(factor.solve(error));
  } else {
    result.chi_square =
        error.isZero(0.) ? 0. : std::numeric_limits<double>::infinity();
  }
  switch (options.test) {
    case CycleTest::kChiSquare:
      result.compatible = result.chi_square <= options.chi_square_bound;
      break;
    case CycleTest::kFixedBound:
      result.compatible = error.head<2>().norm() <= options.translation_bound &&
                          std::abs(error.z()) <= options.rotation_bound;
      break;
  }
  return result;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
