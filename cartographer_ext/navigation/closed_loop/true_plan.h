// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The world's true shapes as a map for a planner: gives the shortest
// collision-free path, with which the driven one is compared, and positions for
// disturbances.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_TRUE_PLAN_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_TRUE_PLAN_H_

#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/navigation/path_planner.h"
#include "cartographer_ext/simulation/ray_caster.h"

namespace cartographer_ext {
namespace navigation {

// Occupied where a line passes, free elsewhere, with a border of one metre.
// Discs are filled. An error where it would need more than 64 million cells.
absl::StatusOr<io::OccupancyMap> DrawShapes(
    const std::vector<simulation::Segment>& segments,
    const std::vector<simulation::Disc>& discs, double resolution);

// Shortest path for a disc of `radius` among the shapes, in the world frame.
absl::StatusOr<Plan> ShortestPath(
    const std::vector<simulation::Segment>& segments,
    const std::vector<simulation::Disc>& discs, double radius,
    const Eigen::Vector2d& start, const Eigen::Vector2d& goal);

// (map <- world) of least squares between the occupied cells of a map and the
// walls of the plan, from a guess that is off by some decimetres at most.
Pose2 AlignMapToWorld(const io::OccupancyMap& map, double occupied_probability,
                      const simulation::RayCaster& plan, const Pose2& guess);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_TRUE_PLAN_H_
