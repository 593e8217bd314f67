// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"

#include <cmath>

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/2d/scan_matching/occupied_space_cost_function_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/rotation_delta_cost_functor_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/translation_delta_cost_functor_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/tsdf_match_cost_function_2d.h"
#include "cartographer/mapping/internal/2d/tsdf_2d.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace scan_matching {
namespace {

ceres::CostFunction* CreateGridCostFunction(
    const double weight, const sensor::PointCloud& point_cloud,
    const Grid2D& grid) {
  // Independent of the number of points.
  const double scaling_factor =
      weight / std::sqrt(static_cast<double>(point_cloud.size()));
  if (grid.GetGridType() == GridType::TSDF) {
    return CreateTSDFMatchCostFunction2D(scaling_factor, point_cloud,
                                         static_cast<const TSDF2D&>(grid));
  }
  return CreateOccupiedSpaceCostFunction2D(scaling_factor, point_cloud, grid);
}

}  // namespace

proto::CeresScanMatcherOptions2D CreateCeresScanMatcherOptions2D(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::CeresScanMatcherOptions2D>(table);
  *options.mutable_ceres_solver_options() = common::ReadTable(
      table, "ceres_solver_options", &common::CreateCeresSolverOptionsProto);
  return options;
}

CeresScanMatcher2D::CeresScanMatcher2D(
    const proto::CeresScanMatcherOptions2D& options)
    : options_(options),
      ceres_solver_options_(
          common::CreateCeresSolverOptions(options.ceres_solver_options())) {
  ceres_solver_options_.linear_solver_type = ceres::DENSE_QR;
}

CeresScanMatcher2D::~CeresScanMatcher2D() = default;

void CeresScanMatcher2D::Match(const Eigen::Vector2d& target_translation,
                               const transform::Rigid2d& initial_pose_estimate,
                               const sensor::PointCloud& point_cloud,
                               const Grid2D& grid,
                               transform::Rigid2d* const pose_estimate,
                               ceres::Solver::Summary* const summary) const {
  CHECK_GT(options_.occupied_space_weight(), 0.);
  CHECK_GT(options_.translation_weight(), 0.);
  CHECK_GT(options_.rotation_weight(), 0.);

  // Everything is read before the output, which may be one of the inputs, is
  // written.
  const double initial_angle = initial_pose_estimate.rotation().angle();
  double pose[3] = {initial_pose_estimate.translation().x(),
                    initial_pose_estimate.translation().y(), initial_angle};
  ceres::Problem problem;
  if (!point_cloud.empty()) {
    problem.AddResidualBlock(
        CreateGridCostFunction(options_.occupied_space_weight(), point_cloud,
                               grid),
        nullptr, pose);
  }
  problem.AddResidualBlock(
      TranslationDeltaCostFunctor2D::CreateAutoDiffCostFunction(
          options_.translation_weight(), target_translation),
      nullptr, pose);
  problem.AddResidualBlock(
      RotationDeltaCostFunctor2D::CreateAutoDiffCostFunction(
          options_.rotation_weight(), initial_angle),
      nullptr, pose);
  ceres::Solve(ceres_solver_options_, &problem, summary);
  *pose_estimate = transform::Rigid2d({pose[0], pose[1]}, pose[2]);
}

}  // namespace scan_matching
}  // namespace mapping
}  // namespace cartographer
