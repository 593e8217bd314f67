// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/cost_functions/spa_cost_function_2d.h"

#include <cmath>

#include "Eigen/Core"
#include "cartographer/common/math.h"
#include "cartographer/mapping/internal/optimization/cost_functions/pose_error.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {
namespace optimization {
namespace {

using Pose = PoseGraphInterface::Constraint::Pose;

ErrorWeights WeightsOf(const Pose& pose) {
  return ErrorWeights{pose.translation_weight, pose.rotation_weight};
}

class AutoDiffSpa {
 public:
  explicit AutoDiffSpa(const Pose& pose)
      : measured_(transform::Project2D(pose.zbar_ij)),
        weights_(WeightsOf(pose)) {}

  template <typename T>
  bool operator()(const T* const start, const T* const end,
                  T* const residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>>(residual, 3) =
        PlanarError(measured_, weights_, start, end);
    return true;
  }

 private:
  const transform::Rigid2d measured_;
  const ErrorWeights weights_;
};

// With R the rotation of the start, d = R^T (t_end - t_start) and z measured,
//   r = (w_t (z_t - d), w_r wrap(z_theta - (theta_end - theta_start))),
//   dd/dt_end = R^T = -dd/dt_start,  dd/dtheta_start = (d_y, -d_x).
class AnalyticalSpa : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit AnalyticalSpa(const Pose& pose)
      : AnalyticalSpa(transform::Project2D(pose.zbar_ij), WeightsOf(pose)) {}

  bool Evaluate(double const* const* const blocks, double* const residuals,
                double** const jacobians) const override {
    using Vector = Eigen::Vector3d;
    const Vector moved = Eigen::Map<const Vector>(blocks[1]) -
                         Eigen::Map<const Vector>(blocks[0]);
    const Eigen::Matrix2d start_from_map = InverseRotation(blocks[0][2]);
    const Eigen::Vector2d seen = start_from_map * moved.head<2>();

    Eigen::Map<Vector> residual(residuals);
    residual.head<2>() = weights_.translation * (translation_ - seen);
    residual[2] =
        weights_.rotation * common::NormalizeAngleDifference(angle_ - moved[2]);
    if (jacobians != nullptr) {
      WriteJacobian(-start_from_map, Eigen::Vector2d::Zero(), -1.,
                    jacobians[1]);
      WriteJacobian(start_from_map, Eigen::Vector2d(-seen.y(), seen.x()), 1.,
                    jacobians[0]);
    }
    return true;
  }

 private:
  AnalyticalSpa(const transform::Rigid2d& measured, const ErrorWeights& weights)
      : translation_(measured.translation()),
        angle_(measured.rotation().angle()),
        weights_(weights) {}

  static Eigen::Matrix2d InverseRotation(const double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    Eigen::Matrix2d result;
    result.row(0) << c, s;
    result.row(1) << -s, c;
    return result;
  }

  // Derivatives of the unweighted residual of one body: of its translation part
  // by position and heading, and of its angle by the heading. `jacobian` may be
  // null.
  void WriteJacobian(const Eigen::Matrix2d& by_position,
                     const Eigen::Vector2d& by_heading,
                     const double angle_by_heading,
                     double* const jacobian) const {
    if (jacobian == nullptr) {
      return;
    }
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> out(jacobian);
    out.topLeftCorner<2, 2>() = weights_.translation * by_position;
    out.topRightCorner<2, 1>() = weights_.translation * by_heading;
    out.row(2) << 0., 0., weights_.rotation * angle_by_heading;
  }

  const Eigen::Vector2d translation_;
  const double angle_;
  const ErrorWeights weights_;
};

}  // namespace

ceres::CostFunction* CreateAutoDiffSpaCostFunction(const Pose& pose) {
  return new ceres::AutoDiffCostFunction<AutoDiffSpa, 3, 3, 3>(
      new AutoDiffSpa(pose));
}

ceres::CostFunction* CreateAnalyticalSpaCostFunction(const Pose& pose) {
  return new AnalyticalSpa(pose);
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
