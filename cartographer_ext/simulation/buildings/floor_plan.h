// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A floor plan under construction: walls and furniture, and the lanes on which
// a robot gets everywhere. Lanes are a graph of straight lines; whatever is
// placed later keeps its distance from them, as people leave the lanes of a
// building free. Metres, world frame.
#ifndef CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_FLOOR_PLAN_H_
#define CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_FLOOR_PLAN_H_

#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "cartographer_ext/simulation/ray_caster.h"

namespace cartographer_ext {
namespace simulation {

using Box = Eigen::AlignedBox2d;

inline Box MakeBox(const double x0, const double y0, const double x1,
                   const double y1) {
  return Box(Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1));
}

struct LaneNode {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  std::vector<int> neighbours;
};

// A room that can be entered.
struct Room {
  Box box;       // its inner walls
  int stop = 0;  // the node where a robot turns round in it
};

struct FloorPlan {
  std::vector<Segment> segments;
  std::vector<Disc> discs;
  std::vector<LaneNode> nodes;
  std::vector<Room> rooms;
  // Corners of the closed outer wall; empty outdoors.
  std::vector<Eigen::Vector2d> outline;
  // Footprints of what has been placed.
  std::vector<Box> occupied;
  // Nodes of one round in their order, from the start to the start.
  std::vector<int> round;
  // How far a drive may stray sideways from a lane.
  double lateral_slack = 0.15;
  // Where people walk: this far beside the lanes, at least and at most.
  double walk_offset_min = 0.6;
  double walk_offset_max = 0.8;
  int people = 0;
  // What a round is prolonged by along its own beginning.
  double overlap = 25.;
};

// What a surface does to a beam, see ray_caster.h.
struct Surface {
  double reflectivity = 1.;
  double echo_angle = kAnyAngle;
};

// A pane returns a beam only where it meets it nearly at a right angle.
Surface Pane();
// Nothing behind it answers: the open air behind a window.
Surface OpenAir();

void AddLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
             const Surface& surface, FloorPlan* plan);
void AddRectangle(const Box& box, FloorPlan* plan);
int AddNode(const Eigen::Vector2d& position, FloorPlan* plan);
void AddLane(int a, int b, FloorPlan* plan);

// Lanes from node to node along the lines x = xs[i] and y = ys[j]. Returns the
// node at (xs[i], ys[j]) as [i][j].
std::vector<std::vector<int>> AddLaneGrid(const std::vector<double>& xs,
                                          const std::vector<double>& ys,
                                          FloorPlan* plan);

// Distance from a straight line to a box, 0 where they meet.
double LineToBox(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                 const Box& box);

// Whether `box` stays `keep` away from every lane and `gap` from everything
// placed.
bool IsFree(const Box& box, double keep, double gap, const FloorPlan& plan);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_BUILDINGS_FLOOR_PLAN_H_
