// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"

#include <cmath>

#include "cartographer/mapping/2d/map_limits.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

using cartographer::mapping::Grid2D;
using cartographer::mapping::GridType;
using cartographer::transform::Rigid2d;

SubmapMatch ToMatch(const bool found, const float score, const Rigid2d& pose) {
  SubmapMatch match;
  match.found = found;
  match.score = found ? static_cast<double>(score) : 0.;
  match.pose = Pose2(pose.translation().x(), pose.translation().y(),
                     pose.normalized_angle());
  return match;
}

}  // namespace

SubmapMatcher::SubmapMatcher(const Grid2D& grid,
                             const cartographer::mapping::scan_matching::proto::
                                 FastCorrelativeScanMatcherOptions2D& options)
    : matcher_(grid, options) {}

SubmapMatch SubmapMatcher::Match(const Pose2& initial,
                                 const double /*linear_window*/,
                                 const double /*angular_window*/,
                                 const cartographer::sensor::PointCloud& cloud,
                                 const double min_score) const {
  float score = 0.f;
  Rigid2d pose = Rigid2d::Identity();
  const bool found =
      matcher_.Match(Rigid2d(initial.translation(), initial.theta), cloud,
                     static_cast<float>(min_score), &score, &pose);
  return ToMatch(found, score, pose);
}

SubmapMatch SubmapMatcher::MatchFullSubmap(
    const cartographer::sensor::PointCloud& cloud,
    const double min_score) const {
  float score = 0.f;
  Rigid2d pose = Rigid2d::Identity();
  const bool found = matcher_.MatchFullSubmap(
      cloud, static_cast<float>(min_score), &score, &pose);
  return ToMatch(found, score, pose);
}

OccupancyView MakeOccupancyView(const Grid2D& grid) {
  const auto& limits = grid.limits();
  const int num_x = limits.cell_limits().num_y_cells;
  const int num_y = limits.cell_limits().num_x_cells;
  const double resolution = limits.resolution();
  OccupancyView view(Eigen::Vector2d(limits.max().x() - resolution * num_x,
                                     limits.max().y() - resolution * num_y),
                     resolution, num_x, num_y);
  const bool is_tsdf = grid.GetGridType() == GridType::TSDF;
  for (int i = 0; i < num_x; ++i) {
    for (int j = 0; j < num_y; ++j) {
      const Eigen::Array2i cell(num_y - 1 - j, num_x - 1 - i);
      if (!grid.IsKnown(cell)) continue;
      const double cost = grid.GetCorrespondenceCost(cell);
      const bool occupied = is_tsdf ? std::abs(cost) < resolution : cost < 0.5;
      view.Set(i, j, occupied ? CellState::kOccupied : CellState::kFree);
    }
  }
  return view;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
