// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "Eigen/Core"
#include "absl/memory/memory.h"
#include "cartographer_ext/common/loop_information.h"
#include "cartographer_ext/optimization/graph/relaxation.h"
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

// A residual r of three with Huber's loss (optimization/graph/relaxation.h),
// for a problem that adds it without a loss. With rho(s) = 2 h(sqrt(s), a), s =
// r^T r, and rho' its derivative, the four residuals
//
//   sqrt(rho') r,  sqrt(rho - rho' s)
//
// have the cost rho / 2. The derivatives handed over are sqrt(rho') J and zero:
// the gradient is exact, J^T rho' r, and the approximation of the second
// derivatives, J^T rho' J, is that of iteratively reweighted least squares, as
// Ceres uses it for losses that grow more slowly than the square.
class HuberCostFunction : public ceres::SizedCostFunction<4, 3, 3> {
 public:
  HuberCostFunction(std::unique_ptr<const ceres::CostFunction> error,
                    const double scale)
      : error_(std::move(error)), scale_(scale) {}

  bool Evaluate(double const* const* const parameters, double* const residuals,
                double** const jacobians) const override {
    using Jacobian = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    using RobustJacobian = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;
    Jacobian errors[2];
    double* wanted[2] = {nullptr, nullptr};
    for (int i = 0; jacobians != nullptr && i != 2; ++i) {
      if (jacobians[i] != nullptr) wanted[i] = errors[i].data();
    }
    if (!error_->Evaluate(parameters, residuals,
                          jacobians != nullptr ? wanted : nullptr)) {
      return false;
    }
    Eigen::Map<Eigen::Vector3d> residual(residuals);
    const double norm = residual.norm();
    const double sqrt_slope = norm > scale_ ? std::sqrt(scale_ / norm) : 1.;
    residual *= sqrt_slope;
    residuals[3] = std::sqrt(std::max(0., scale_ * (norm - scale_)));
    for (int i = 0; i != 2; ++i) {
      if (wanted[i] == nullptr) continue;
      Eigen::Map<RobustJacobian> jacobian(jacobians[i]);
      jacobian.topRows<3>() = sqrt_slope * errors[i];
      jacobian.row(3).setZero();
    }
    return true;
  }

 private:
  const std::unique_ptr<const ceres::CostFunction> error_;
  const double scale_;
};

ceres::CostFunction* Create(ceres::CostFunction* (*const stock)(const Pose&),
                            const Pose& pose) {
  const auto* const relaxation =
      ::cartographer_ext::optimization::ScopedRelaxation::Current();
  const double factor = relaxation == nullptr ? 1. : relaxation->factor();
  Pose weighted = pose;
  Eigen::Matrix3d sqrt_information;
  if (::cartographer_ext::ScopedSqrtInformation::Find(&pose,
                                                      &sqrt_information)) {
    weighted.translation_weight = 1.;
    weighted.rotation_weight = 1.;
    return new WeightedCostFunction(
        std::unique_ptr<const ceres::CostFunction>(stock(weighted)),
        factor * sqrt_information);
  }
  if (relaxation == nullptr) return stock(pose);
  weighted.translation_weight *= factor;
  weighted.rotation_weight *= factor;
  const double step_scale = relaxation->StepScale(
      &pose, pose.translation_weight, pose.rotation_weight);
  if (step_scale == 0.) return stock(weighted);
  weighted.translation_weight *=
      relaxation->relaxation().step_translation_factor;
  weighted.rotation_weight *= relaxation->relaxation().step_rotation_factor;
  return new HuberCostFunction(
      std::unique_ptr<const ceres::CostFunction>(stock(weighted)), step_scale);
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
