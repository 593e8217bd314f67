// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/cycle_consistency.h"

#include <cmath>
#include <limits>

#include "Eigen/Cholesky"

namespace cartographer_ext {
namespace uncertainty {

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

}  // namespace uncertainty
}  // namespace cartographer_ext
