// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The drive through a plan: shortest paths along its lanes from stop to stop of
// the round (Dijkstra 1959), several laps of it, and at the end the start of
// the route again, so that even a forward-looking laser revisits places.
#ifndef CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_ROUTE_H_
#define CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_ROUTE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/simulation/buildings/floor_plan.h"

namespace cartographer_ext {
namespace simulation {

struct RouteOptions {
  int laps = 1;
  bool turns_back = true;  // may go back along the lane it came
};

// The nodes passed, the overlap included; empty where no path leads on.
std::vector<int> RouteNodes(const FloorPlan& plan, const RouteOptions& options);

// The same as waypoints in metres: only where the path bends, and between far
// ones points that stray sideways by up to the plan's slack.
std::vector<Eigen::Vector2d> Waypoints(const FloorPlan& plan,
                                       const std::vector<int>& nodes,
                                       Random* random);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_ROUTE_H_
