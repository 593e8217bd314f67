// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Plans a path in metres from a start to a goal: A* over the weights of the
// costmap, then straight lines wherever they cost no more than the steps they
// replace.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_PATH_PLANNER_H_
#define CARTOGRAPHER_EXT_NAVIGATION_PATH_PLANNER_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/navigation/costmap.h"
#include "cartographer_ext/navigation/grid_search.h"
#include "cartographer_ext/navigation/obstacle_layer.h"

namespace cartographer_ext {
namespace navigation {

enum class PlanOutcome {
  kFound,
  kNotFinite,       // start or goal is not a number
  kGoalOutside,     // of the map
  kGoalOccupied,    // in a wall
  kGoalUnknown,     // in unknown space
  kGoalTooNear,     // the robot would touch a wall
  kGoalObstructed,  // by an obstacle that the map lacks
  kStartBlocked,    // no free cell near the start
  kUnreachable,     // the map has no path
  kObstructed,      // the map has one, but obstacles block it
};

// A sentence for the user.
std::string ToString(PlanOutcome outcome);
// Whether waiting would not change the outcome.
bool IsFinal(PlanOutcome outcome);

struct Plan {
  PlanOutcome outcome = PlanOutcome::kUnreachable;
  std::vector<Eigen::Vector2d>
      points;            // corners, from start to goal, map frame
  double length = 0.;    // metres
  int64_t expanded = 0;  // cells

  bool found() const { return outcome == PlanOutcome::kFound; }
};

// Sum of weight times length in cells along the straight line between the
// centres of two cells; infinite where it passes a blocked one.
double LineCost(const WeightGrid& grid, const Cell& from, const Cell& to);

// Leaves out cells of a path between which the straight line is as cheap, up to
// `tolerance` (relative).
std::vector<Cell> SimplifyPath(const WeightGrid& grid,
                               const std::vector<Cell>& path, double tolerance);

double PathLength(const std::vector<Eigen::Vector2d>& points);

class PathPlanner {
 public:
  // The costmap must outlive the planner.
  explicit PathPlanner(const Costmap* costmap) : costmap_(costmap) {}

  // `obstacles` may be null. A start that is blocked, by less than
  // `start_tolerance` metres, begins at the nearest cell that is free.
  Plan MakePlan(const Eigen::Vector2d& start, const Eigen::Vector2d& goal,
                const ObstacleLayer* obstacles);

  // Cost of a path, by LineCost, among the obstacles of the last plan, as
  // metres of free path; infinite where something blocks it.
  double Cost(const std::vector<Eigen::Vector2d>& points) const;

  static constexpr double kStartTolerance = 0.5;   // metres
  static constexpr double kSimplification = 0.02;  // relative cost

 private:
  PlanOutcome CheckGoal(const Cell& goal, const WeightGrid& weights) const;
  // Nearest cell that is not blocked; outside the map if there is none.
  Cell NearestFree(const Cell& cell, const WeightGrid& weights) const;

  const Costmap* const costmap_;
  GridSearch search_;
  bool obstructed_ = false;  // whether weights_ are those of the last plan
  WeightGrid weights_;       // with obstacles, kept for its memory
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_PATH_PLANNER_H_
