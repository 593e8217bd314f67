// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"

#include <memory>
#include <utility>

#include "Eigen/Core"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/overlay/signature.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_SPA_COST_FUNCTION_2D_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Pose = PoseGraphInterface::Constraint::Pose;

CARTOGRAPHER_EXT_EXPECT_SIGNATURE(StockCreateAutoDiffSpaCostFunction,
                                  ceres::CostFunction* (*)(const Pose&));
CARTOGRAPHER_EXT_EXPECT_SIGNATURE(StockCreateAnalyticalSpaCostFunction,
                                  ceres::CostFunction* (*)(const Pose&));

// S times a residual of three with parameter blocks of three.
class WeightedCostFunction : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  WeightedCostFunction(std::unique_ptr<const ceres::CostFunction> error,
                       const Eigen::Matrix3d& sqrt_information)
      : error_(std::move(error)) {
    Eigen::Map<Eigen::Matrix3d> stored(sqrt_information_);
    stored = sqrt_information;
  }

  bool Evaluate(double const* const* const parameters, double* const residuals,
                double** const jacobians) const override {
    using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (!error_->Evaluate(parameters, residuals, jacobians)) return false;
    const Eigen::Map<const Eigen::Matrix3d> sqrt(sqrt_information_);
    Eigen::Map<Eigen::Vector3d> residual(residuals);
    residual = (sqrt * residual).eval();
    if (jacobians == nullptr) return true;
    for (int i = 0; i != 2; ++i) {
      if (jacobians[i] == nullptr) continue;
      Eigen::Map<RowMajor3> jacobian(jacobians[i]);
      jacobian = (sqrt * jacobian).eval();
    }
    return true;
  }

 private:
  const std::unique_ptr<const ceres::CostFunction> error_;
  // Numbers instead of a matrix, which would ask for aligned memory.
  double sqrt_information_[9];
};

ceres::CostFunction* Create(ceres::CostFunction* (*const stock)(const Pose&),
                            const Pose& pose) {
  Eigen::Matrix3d sqrt_information;
  if (!::cartographer_ext::ScopedSqrtInformation::Find(&pose,
                                                       &sqrt_information)) {
    return stock(pose);
  }
  Pose unweighted = pose;
  unweighted.translation_weight = 1.;
  unweighted.rotation_weight = 1.;
  return new WeightedCostFunction(
      std::unique_ptr<const ceres::CostFunction>(stock(unweighted)),
      sqrt_information);
}

}  // namespace

ceres::CostFunction* CreateAutoDiffSpaCostFunction(const Pose& pose) {
  return Create(&StockCreateAutoDiffSpaCostFunction, pose);
}

ceres::CostFunction* CreateAnalyticalSpaCostFunction(const Pose& pose) {
  return Create(&StockCreateAnalyticalSpaCostFunction, pose);
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
