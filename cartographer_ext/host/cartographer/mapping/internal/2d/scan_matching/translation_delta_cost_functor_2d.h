// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_TRANSLATION_DELTA_COST_FUNCTOR_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_TRANSLATION_DELTA_COST_FUNCTOR_2D_H_

#include "Eigen/Core"
#include "ceres/ceres.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {

// scaling_factor * (translation of the pose - target), two residuals. Poses are
// (x, y, theta).
class TranslationDeltaCostFunctor2D {
 public:
  static ceres::CostFunction* CreateAutoDiffCostFunction(
      const double scaling_factor, const Eigen::Vector2d& target_translation) {
    using CostFunction =
        ceres::AutoDiffCostFunction<TranslationDeltaCostFunctor2D, 2, 3>;
    return new CostFunction(
        new TranslationDeltaCostFunctor2D(scaling_factor, target_translation));
  }

  template <typename T>
  bool operator()(const T* const pose, T* const residual) const {
    for (int axis = 0; axis != 2; ++axis) {
      residual[axis] = scaling_factor_ * (pose[axis] - target_[axis]);
    }
    return true;
  }

 private:
  TranslationDeltaCostFunctor2D(const double scaling_factor,
                                const Eigen::Vector2d& target)
      : scaling_factor_(scaling_factor), target_{target.x(), target.y()} {}

  const double scaling_factor_;
  const double target_[2];
};

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_SCAN_MATCHING_TRANSLATION_DELTA_COST_FUNCTOR_2D_H_
