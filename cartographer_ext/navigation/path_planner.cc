// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/path_planner.h"

#include <cmath>
#include <limits>

#include "cartographer_ext/navigation/grid_ray.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// Longest straight piece, in cells: bounds the work of the simplification.
constexpr size_t kMaxPiece = 400;

Eigen::Vector2d CenterInCells(const Cell& cell) {
  return Eigen::Vector2d(cell.x + 0.5, cell.y + 0.5);
}

}  // namespace

std::string ToString(const PlanOutcome outcome) {
  switch (outcome) {
    case PlanOutcome::kFound:
      return "path found";
    case PlanOutcome::kNotFinite:
      return "start or goal is not a number";
    case PlanOutcome::kGoalOutside:
      return "the goal is outside the map";
    case PlanOutcome::kGoalOccupied:
      return "the goal is in a wall";
    case PlanOutcome::kGoalUnknown:
      return "the goal is in unknown space";
    case PlanOutcome::kGoalTooNear:
      return "the goal is too near to a wall for the robot";
    case PlanOutcome::kGoalObstructed:
      return "there is an obstacle at the goal";
    case PlanOutcome::kStartBlocked:
      return "there is no free space around the start";
    case PlanOutcome::kUnreachable:
      return "the map has no path to the goal";
    case PlanOutcome::kObstructed:
      return "obstacles block every path to the goal";
  }
  return "";
}

bool IsFinal(const PlanOutcome outcome) {
  switch (outcome) {
    case PlanOutcome::kFound:
    case PlanOutcome::kGoalObstructed:
    case PlanOutcome::kStartBlocked:
    case PlanOutcome::kObstructed:
      return false;
    default:
      return true;
  }
}

double LineCost(const WeightGrid& grid, const Cell& from, const Cell& to) {
  double cost = 0.;
  const bool free =
      VisitLine(CenterInCells(from), CenterInCells(to),
                [&](const Cell& cell, const double length) {
                  if (!grid.Contains(cell) || grid.at(cell) == kBlocked)
                    return false;
                  cost += grid.at(cell) * length;
                  return true;
                });
  return free ? cost : std::numeric_limits<double>::infinity();
}

std::vector<Cell> SimplifyPath(const WeightGrid& grid,
                               const std::vector<Cell>& path,
                               const double tolerance) {
  if (path.size() < 3) return path;
  // Cost from the first cell, by the same measure as LineCost.
  std::vector<double> costs(path.size(), 0.);
  for (size_t i = 1; i != path.size(); ++i) {
    const double length =
        std::hypot(path[i].x - path[i - 1].x, path[i].y - path[i - 1].y);
    costs[i] =
        costs[i - 1] + 0.5 * length * (grid.at(path[i - 1]) + grid.at(path[i]));
  }
  std::vector<Cell> corners = {path.front()};
  size_t corner = 0;
  while (corner + 1 != path.size()) {
    size_t next = corner + 1;
    for (size_t i = corner + 2; i != path.size() && i - corner <= kMaxPiece;
         ++i) {
      const double allowed = (1. + tolerance) * (costs[i] - costs[corner]);
      const double cost = LineCost(grid, path[corner], path[i]);
      if (cost <= allowed) next = i;
      // A blocked line remains blocked with more cells; one that costs a little
      // more may become cheaper again.
      if (std::isinf(cost) || i - next > 40) break;
    }
    corners.push_back(path[next]);
    corner = next;
  }
  return corners;
}

double PathLength(const std::vector<Eigen::Vector2d>& points) {
  double length = 0.;
  for (size_t i = 1; i < points.size(); ++i) {
    length += (points[i] - points[i - 1]).norm();
  }
  return length;
}

PlanOutcome PathPlanner::CheckGoal(const Cell& goal,
                                   const WeightGrid& weights) const {
  if (!costmap_->geometry().Contains(goal)) return PlanOutcome::kGoalOutside;
  if (costmap_->state(goal) == CellState::kOccupied) {
    return PlanOutcome::kGoalOccupied;
  }
  if (costmap_->state(goal) == CellState::kUnknown &&
      !costmap_->options().unknown_is_free) {
    return PlanOutcome::kGoalUnknown;
  }
  if (costmap_->weights().at(goal) == kBlocked) {
    return PlanOutcome::kGoalTooNear;
  }
  return weights.at(goal) == kBlocked ? PlanOutcome::kGoalObstructed
                                      : PlanOutcome::kFound;
}

Cell PathPlanner::NearestFree(const Cell& cell,
                              const WeightGrid& weights) const {
  if (weights.Contains(cell) && weights.at(cell) != kBlocked) return cell;
  const int reach = static_cast<int>(
      std::ceil(kStartTolerance / costmap_->geometry().resolution()));
  Cell nearest{-1, -1};
  int nearest_squared = reach * reach + 1;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const Cell other{cell.x + dx, cell.y + dy};
      const int squared = dx * dx + dy * dy;
      if (squared < nearest_squared && weights.Contains(other) &&
          weights.at(other) != kBlocked) {
        nearest = other;
        nearest_squared = squared;
      }
    }
  }
  return nearest;
}

double PathPlanner::Cost(const std::vector<Eigen::Vector2d>& points) const {
  const WeightGrid& weights = obstructed_ ? weights_ : costmap_->weights();
  const GridGeometry& geometry = costmap_->geometry();
  double cost = 0.;
  for (size_t i = 1; i < points.size(); ++i) {
    cost += LineCost(weights, geometry.CellAt(points[i - 1]),
                     geometry.CellAt(points[i]));
  }
  return cost * geometry.resolution() / kMinWeight;
}

Plan PathPlanner::MakePlan(const Eigen::Vector2d& start,
                           const Eigen::Vector2d& goal,
                           const ObstacleLayer* const obstacles) {
  Plan plan;
  if (!start.allFinite() || !goal.allFinite()) {
    plan.outcome = PlanOutcome::kNotFinite;
    return plan;
  }
  const bool obstructed = obstacles != nullptr && !obstacles->marks().empty();
  obstructed_ = obstructed;
  if (obstructed) obstacles->ApplyTo(&weights_);
  const WeightGrid& weights = obstructed ? weights_ : costmap_->weights();
  const GridGeometry& geometry = costmap_->geometry();
  const Cell goal_cell = geometry.CellAt(goal);
  plan.outcome = CheckGoal(goal_cell, weights);
  if (!plan.found()) return plan;
  const Cell start_cell = NearestFree(geometry.CellAt(start), weights);
  if (!geometry.Contains(start_cell)) {
    plan.outcome = PlanOutcome::kStartBlocked;
    return plan;
  }
  const GridPath path = search_.Search(weights, start_cell, goal_cell);
  plan.expanded = path.expanded;
  if (!path.found) {
    plan.outcome = obstructed && search_
                                     .Search(costmap_->weights(),
                                             NearestFree(geometry.CellAt(start),
                                                         costmap_->weights()),
                                             goal_cell)
                                     .found
                       ? PlanOutcome::kObstructed
                       : PlanOutcome::kUnreachable;
    return plan;
  }
  const std::vector<Cell> corners =
      SimplifyPath(weights, path.cells, kSimplification);
  plan.points.push_back(start);
  // The path starts at the robot itself, unless its cell is blocked.
  for (size_t i = start_cell == geometry.CellAt(start) ? 1 : 0;
       i < corners.size(); ++i) {
    plan.points.push_back(geometry.Center(corners[i]));
  }
  if (plan.points.size() == 1) {
    plan.points.push_back(goal);
  } else {
    plan.points.back() = goal;
  }
  plan.length = PathLength(plan.points);
  return plan;
}

}  // namespace navigation
}  // namespace cartographer_ext
