// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/true_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Eigen/Cholesky"
#include "absl/strings/str_format.h"
#include "cartographer_ext/navigation/grid_ray.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kBorder = 1.;        // metres
constexpr double kResolution = 0.05;  // metres a cell of the shortest path
constexpr double kMaxCells = 64e6;
constexpr int kAlignmentPoints = 4000;
constexpr int kAlignmentIterations = 12;
constexpr double kDerivativeStep = 1e-3;  // metres

}  // namespace

absl::StatusOr<io::OccupancyMap> DrawShapes(
    const std::vector<simulation::Segment>& segments,
    const std::vector<simulation::Disc>& discs, const double resolution) {
  Eigen::Vector2d low =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const auto& segment : segments) {
    low = low.cwiseMin(segment.a).cwiseMin(segment.b);
    high = high.cwiseMax(segment.a).cwiseMax(segment.b);
  }
  for (const auto& disc : discs) {
    const Eigen::Vector2d radius = Eigen::Vector2d::Constant(disc.radius);
    low = low.cwiseMin(disc.center - radius);
    high = high.cwiseMax(disc.center + radius);
  }
  if (!low.allFinite() || !high.allFinite()) {
    return absl::InvalidArgumentError("the world has no shapes");
  }
  low -= Eigen::Vector2d::Constant(kBorder);
  high += Eigen::Vector2d::Constant(kBorder);
  const Eigen::Vector2d cells = (high - low) / resolution;
  if (cells.x() * cells.y() > kMaxCells) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the world of %.0f m x %.0f m is too large for navigation",
        high.x() - low.x(), high.y() - low.y()));
  }
  io::OccupancyMap map =
      io::OccupancyMap::Make(static_cast<int>(std::ceil(cells.x())),
                             static_cast<int>(std::ceil(cells.y())), resolution,
                             Pose2(low.x(), low.y(), 0.));
  std::fill(map.occupancy.begin(), map.occupancy.end(), 0.f);
  const GridGeometry geometry(map);
  for (const auto& segment : segments) {
    VisitLine(geometry.ToGrid(segment.a), geometry.ToGrid(segment.b),
              [&](const Cell& cell, double /*length*/) {
                map.at(cell.x, cell.y) = 1.f;
                return true;
              });
  }
  for (const auto& disc : discs) {
    const int reach = static_cast<int>(std::ceil(disc.radius / resolution)) + 1;
    const Cell middle = geometry.CellAt(disc.center);
    for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
      for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
        if (geometry.Contains({x, y}) &&
            (geometry.Center({x, y}) - disc.center).norm() <= disc.radius) {
          map.at(x, y) = 1.f;
        }
      }
    }
  }
  return map;
}

absl::StatusOr<Plan> ShortestPath(
    const std::vector<simulation::Segment>& segments,
    const std::vector<simulation::Disc>& discs, const double radius,
    const Eigen::Vector2d& start, const Eigen::Vector2d& goal) {
  const auto map = DrawShapes(segments, discs, kResolution);
  if (!map.ok()) return map.status();
  CostmapOptions options;
  options.inscribed_radius = radius;
  options.padding = 0.;
  options.tight = 0.;
  options.inflation_radius = radius;
  options.clearance_weight = 0.;
  const auto costmap = Costmap::Create(*map, options);
  if (!costmap.ok()) return costmap.status();
  return PathPlanner(&*costmap).MakePlan(start, goal, nullptr);
}

Pose2 AlignMapToWorld(const io::OccupancyMap& map,
                      const double occupied_probability,
                      const simulation::RayCaster& plan, const Pose2& guess) {
  const GridGeometry geometry(map);
  std::vector<Eigen::Vector2d> points;
  for (size_t i = 0; i != map.occupancy.size(); ++i) {
    if (map.occupancy[i] >= occupied_probability) {
      points.push_back(geometry.Center(geometry.CellOfIndex(i)));
    }
  }
  const size_t stride = std::max<size_t>(1, points.size() / kAlignmentPoints);
  Pose2 world_from_map = guess.Inverse();
  for (int iteration = 0; iteration != kAlignmentIterations; ++iteration) {
    // Walls of the map that the plan lacks, such as people and moved furniture,
    // are outliers of the fit.
    const double limit = iteration < 4 ? 0.6 : 0.15;
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < points.size(); i += stride) {
      const Eigen::Vector2d p = world_from_map * points[i];
      const double distance = plan.Clearance(p, limit);
      if (!(distance < limit)) continue;
      const Eigen::Vector2d dx(kDerivativeStep, 0.), dy(0., kDerivativeStep);
      const Eigen::Vector2d normal(plan.Clearance(p + dx, 2. * limit) -
                                       plan.Clearance(p - dx, 2. * limit),
                                   plan.Clearance(p + dy, 2. * limit) -
                                       plan.Clearance(p - dy, 2. * limit));
      const Eigen::Vector2d slope = normal / (2. * kDerivativeStep);
      const Eigen::Vector2d arm = p - world_from_map.translation();
      const Eigen::Vector3d jacobian(slope.x(), slope.y(),
                                     slope.y() * arm.x() - slope.x() * arm.y());
      hessian += jacobian * jacobian.transpose();
      gradient += distance * jacobian;
    }
    const Eigen::Vector3d step = -hessian.ldlt().solve(gradient);
    if (!step.allFinite()) break;
    world_from_map.x += step.x();
    world_from_map.y += step.y();
    world_from_map.theta = NormalizeAngle(world_from_map.theta + step.z());
    if (step.norm() < 1e-6) break;
  }
  return world_from_map.Inverse();
}

}  // namespace navigation
}  // namespace cartographer_ext
