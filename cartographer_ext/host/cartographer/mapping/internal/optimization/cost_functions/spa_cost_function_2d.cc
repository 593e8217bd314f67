// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"

#include <cmath>

#include "Eigen/Core"
#include "cartographer/common/math.h"
#include "cartographer/mapping/internal/optimization/cost_functions/cost_helpers.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

struct AutoDiffSpa {
  template <typename T>
  bool operator()(const T* const start, const T* const end,
                  T* const residual) const {
    const auto error = ScaleError(ComputeUnscaledError(measured, start, end),
                                  translation_weight, rotation_weight);
    std::copy(error.begin(), error.end(), residual);
    return true;
  }

  transform::Rigid2d measured;
  double translation_weight;
  double rotation_weight;
};

class AnalyticalSpa : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit AnalyticalSpa(const PoseGraphInterface::Constraint::Pose& pose)
      : AnalyticalSpa(transform::Project2D(pose.zbar_ij),
                      pose.translation_weight, pose.rotation_weight) {}

  bool Evaluate(double const* const* const parameters, double* const residuals,
                double** const jacobians) const override {
    const double* const start = parameters[0];
    const double* const end = parameters[1];
    const double c = std::cos(start[2]);
    const double s = std::sin(start[2]);
    const double dx = end[0] - start[0];
    const double dy = end[1] - start[1];
    // The second body in the frame of the first.
    const double x = c * dx + s * dy;
    const double y = c * dy - s * dx;
    residuals[0] = translation_weight_ * (x_ - x);
    residuals[1] = translation_weight_ * (y_ - y);
    residuals[2] = rotation_weight_ * common::NormalizeAngleDifference(
                                          angle_ - (end[2] - start[2]));
    if (jacobians == nullptr) {
      return true;
    }
    using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const double wc = translation_weight_ * c;
    const double ws = translation_weight_ * s;
    if (jacobians[0] != nullptr) {
      // dx/dtheta_i = y and dy/dtheta_i = -x.
      Eigen::Map<RowMajor3>(jacobians[0], 3, 3) << wc, ws,
          -translation_weight_ * y, -ws, wc, translation_weight_ * x, 0., 0.,
          rotation_weight_;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor3>(jacobians[1], 3, 3) << -wc, -ws, 0., ws, -wc, 0.,
          0., 0., -rotation_weight_;
    }
    return true;
  }

 private:
  AnalyticalSpa(const transform::Rigid2d& measured,
                const double translation_weight, const double rotation_weight)
      : x_(measured.translation().x()),
        y_(measured.translation().y()),
        angle_(measured.rotation().angle()),
        translation_weight_(translation_weight),
        rotation_weight_(rotation_weight) {}

  const double x_;
  const double y_;
  const double angle_;
  const double translation_weight_;
  const double rotation_weight_;
};

}  // namespace

ceres::CostFunction* CreateAutoDiffSpaCostFunction(
    const PoseGraphInterface::Constraint::Pose& pose) {
  return new ceres::AutoDiffCostFunction<AutoDiffSpa, 3, 3, 3>(
      new AutoDiffSpa{transform::Project2D(pose.zbar_ij),
                      pose.translation_weight, pose.rotation_weight});
}

ceres::CostFunction* CreateAnalyticalSpaCostFunction(
    const PoseGraphInterface::Constraint::Pose& pose) {
  return new AnalyticalSpa(pose);
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
