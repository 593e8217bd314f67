// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/match_information.h"

#include <utility>
#include <vector>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/scan_matching/cost_curvature.h"
#include "cartographer_ext/scan_matching/dropin/grid_cells.h"
#include "cartographer_ext/scan_matching/occupied_space_cost.h"
#include "cartographer_ext/uncertainty/match_information.h"
#include "cartographer_ext/uncertainty/scan_curvature.h"

namespace cartographer_ext {
namespace loop_closure {

using cartographer::mapping::Grid2D;
using scan_matching::GridCells;

namespace {

// As in local SLAM, cells.
constexpr double kStep = 2.;

}  // namespace

Eigen::Matrix3d MatchInformation(const Grid2D& grid,
                                 const cartographer::sensor::PointCloud& cloud,
                                 const Pose2& pose, const Pose2& submap_pose) {
  if (grid.GetGridType() == cartographer::mapping::GridType::TSDF ||
      cloud.empty()) {
    return Eigen::Matrix3d::Zero();
  }
  std::vector<Eigen::Vector2d> points;
  points.reserve(cloud.size());
  for (const auto& point : cloud) {
    points.emplace_back(point.position.x(), point.position.y());
  }
  const GridCells cells(&grid);
  scan_matching::OccupiedSpaceCost<GridCells> cost(&cells, std::move(points));
  const uncertainty::ScaledMotion motion(cost.points(), cells.resolution(),
                                         pose);
  const Eigen::Matrix3d hessian = cost.Evaluate(pose).hessian;
  const uncertainty::MatchInformation match =
      uncertainty::EstimateMatchInformation(
          uncertainty::MatchInformationOptions(), motion,
          scan_matching::MeasureCurvature(cost, motion, hessian, kStep),
          static_cast<int>(cloud.size()));
  // Moving (submap <- cloud) by d moves (grid <- cloud) by the rotated d.
  const Eigen::Matrix3d rotation = PlanarRotation(submap_pose.theta);
  return rotation.transpose() * match.information * rotation;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
