// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A made-up map for the tests of self-consistency: a square room of 8 m whose
// middle is the origin, seen by nodes in it, and submaps that show it.
#ifndef TESTS_MAP_VERDICT_BOX_WORLD_H_
#define TESTS_MAP_VERDICT_BOX_WORLD_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "cartographer/mapping/proto/grid_2d.pb.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace test {

constexpr double kHalfSide = 4.;  // metres
constexpr double kCell = 0.1;     // metres
constexpr double kSway = 0.15;    // metres

// Walls are two cells thick, free inside, unknown outside.
inline cartographer::mapping::proto::Grid2D BoxGrid() {
  cartographer::mapping::proto::Grid2D grid;
  constexpr int kCells = 100;
  grid.mutable_limits()->set_resolution(kCell);
  grid.mutable_limits()->mutable_max()->set_x(5.);
  grid.mutable_limits()->mutable_max()->set_y(5.);
  grid.mutable_limits()->mutable_cell_limits()->set_num_x_cells(kCells);
  grid.mutable_limits()->mutable_cell_limits()->set_num_y_cells(kCells);
  grid.mutable_probability_grid_2d();
  grid.set_min_correspondence_cost(0.1f);
  grid.set_max_correspondence_cost(0.9f);
  for (int iy = 0; iy < kCells; ++iy) {
    for (int ix = 0; ix < kCells; ++ix) {
      const double x = std::abs(5. - (iy + 0.5) * kCell);
      const double y = std::abs(5. - (ix + 0.5) * kCell);
      const double reach = std::max(x, y);
      grid.add_cells(reach < kHalfSide - kCell   ? 30000
                     : reach < kHalfSide + kCell ? 1000
                                                 : 0);
    }
  }
  return grid;
}

// Returns of a scan all around from a pose in the room, in its own frame.
inline std::vector<Eigen::Vector2d> BoxScan(const Pose2& pose) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 180; ++i) {
    const double angle = i * kPi / 90.;
    const Eigen::Vector2d ray(std::cos(pose.theta + angle),
                              std::sin(pose.theta + angle));
    double range = 100.;
    for (const int axis : {0, 1}) {
      if (std::abs(ray[axis]) < 1e-9) continue;
      const double at = axis == 0 ? pose.x : pose.y;
      range = std::min(
          range, ((ray[axis] > 0. ? kHalfSide : -kHalfSide) - at) / ray[axis]);
    }
    points.push_back(range * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

struct BoxWorld {
  evaluation::MapGraph graph;
  evaluation::MapContents contents;
};

// Nodes 0 to 99 drive on a line in the room, swaying to either side, so that the
// last are on another visit than the first (IsOneVisit); submap 0 has nodes 0 to
// 9, submap 1 nodes 90 to 99. From node `first_wrong` on, the map has everything
// moved by `wrong`.
inline BoxWorld MakeBoxWorld(const int first_wrong, const Pose2& wrong,
                             const double sway = kSway) {
  using evaluation::GraphId;
  BoxWorld world;
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose(-1. + 0.02 * i, 0.3 + (i % 2 == 0 ? sway : -sway),
                     0.01 * i);
    evaluation::GraphNode node;
    node.time = i * 1000000000LL;
    node.local_pose = pose;
    node.global_pose = i >= first_wrong ? wrong * pose : pose;
    node.global_tracking_pose = evaluation::ToIsometry(node.global_pose);
    world.graph.nodes[{0, i}] = node;
    world.contents.scans[{0, i}] = BoxScan(pose);
  }
  for (const int index : {0, 1}) {
    evaluation::GraphSubmap submap;
    submap.finished = true;
    submap.num_range_data = 10;
    if (90 * index >= first_wrong) submap.global_pose = wrong;
    world.graph.submaps[{0, index}] = submap;
    world.contents.submaps.emplace(
        GraphId{0, index}, evaluation::SubmapCells(
                               *evaluation::SubmapGrid::Make(BoxGrid()), 0.15));
    for (int i = 0; i < 10; ++i) {
      evaluation::GraphConstraint constraint;
      constraint.submap_id = {0, index};
      constraint.node_id = {0, 90 * index + i};
      constraint.relative_pose =
          world.graph.nodes.at(constraint.node_id).local_pose;
      world.graph.constraints.push_back(constraint);
    }
  }
  return world;
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_MAP_VERDICT_BOX_WORLD_H_
