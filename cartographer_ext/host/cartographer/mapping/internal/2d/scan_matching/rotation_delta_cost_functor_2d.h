// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_ROTATION_DELTA_COST_FUNCTOR_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_ROTATION_DELTA_COST_FUNCTOR_2D_H_

#include "ceres/ceres.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// scaling_factor * (angle of the pose - target), one residual. The difference
// is not wrapped.
class RotationDeltaCostFunctor2D {
 public:
  static ceres::CostFunction* CreateAutoDiffCostFunction(
      const double scaling_factor, const double target_angle) {
    using CostFunction =
        ceres::AutoDiffCostFunction<RotationDeltaCostFunctor2D, 1, 3>;
    return new CostFunction(
        new RotationDeltaCostFunctor2D(scaling_factor, target_angle));
  }

  template <typename T>
  bool operator()(const T* const pose, T* const residual) const {
    *residual = scaling_factor_ * (pose[2] - target_angle_);
    return true;
  }

 private:
  RotationDeltaCostFunctor2D(const double scaling_factor,
                             const double target_angle)
      : scaling_factor_(scaling_factor), target_angle_(target_angle) {}

  const double scaling_factor_;
  const double target_angle_;
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_ROTATION_DELTA_COST_FUNCTOR_2D_H_
