// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/buildings/floor_plan.h"

#include <algorithm>

#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace simulation {

Surface Pane() { return {0.5, DegToRad(20.)}; }

Surface OpenAir() { return {1e-3, kAnyAngle}; }

void AddLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
             const Surface& surface, FloorPlan* plan) {
  if ((b - a).norm() < 1e-6) return;
  plan->segments.push_back({a, b, surface.reflectivity, surface.echo_angle});
}

void AddRectangle(const Box& box, FloorPlan* plan) {
  const Eigen::Vector2d a = box.min(), c = box.max();
  const Eigen::Vector2d b(c.x(), a.y()), d(a.x(), c.y());
  AddLine(a, b, Surface(), plan);
  AddLine(b, c, Surface(), plan);
  AddLine(c, d, Surface(), plan);
  AddLine(d, a, Surface(), plan);
}

int AddNode(const Eigen::Vector2d& position, FloorPlan* plan) {
  LaneNode node;
  node.position = position;
  plan->nodes.push_back(std::move(node));
  return static_cast<int>(plan->nodes.size()) - 1;
}

void AddLane(const int a, const int b, FloorPlan* plan) {
  plan->nodes[a].neighbours.push_back(b);
  plan->nodes[b].neighbours.push_back(a);
}

std::vector<std::vector<int>> AddLaneGrid(const std::vector<double>& xs,
                                          const std::vector<double>& ys,
                                          FloorPlan* plan) {
  std::vector<std::vector<int>> grid(xs.size(), std::vector<int>(ys.size()));
  for (size_t i = 0; i != xs.size(); ++i) {
    for (size_t j = 0; j != ys.size(); ++j) {
      grid[i][j] = AddNode({xs[i], ys[j]}, plan);
      if (i > 0) AddLane(grid[i - 1][j], grid[i][j], plan);
      if (j > 0) AddLane(grid[i][j - 1], grid[i][j], plan);
    }
  }
  return grid;
}

double LineToBox(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                 const Box& box) {
  // The part of the line inside the box (Liang and Barsky 1984).
  double enter = 0., leave = 1.;
  for (int axis = 0; axis != 2; ++axis) {
    const double step = b[axis] - a[axis];
    const double low = box.min()[axis] - a[axis];
    const double high = box.max()[axis] - a[axis];
    if (step == 0.) {
      if (low > 0. || high < 0.) enter = 2.;
      continue;
    }
    enter = std::max(enter, std::min(low / step, high / step));
    leave = std::min(leave, std::max(low / step, high / step));
  }
  if (enter <= leave) return 0.;
  double distance = std::min(box.exteriorDistance(a), box.exteriorDistance(b));
  const Segment line{a, b, 1., kAnyAngle};
  for (const double x : {box.min().x(), box.max().x()}) {
    for (const double y : {box.min().y(), box.max().y()}) {
      distance = std::min(distance, PointToSegment({x, y}, line));
    }
  }
  return distance;
}

bool IsFree(const Box& box, const double keep, const double gap,
            const FloorPlan& plan) {
  for (size_t i = 0; i != plan.nodes.size(); ++i) {
    const Eigen::Vector2d& from = plan.nodes[i].position;
    if (box.exteriorDistance(from) < keep) return false;
    for (const int j : plan.nodes[i].neighbours) {
      if (j < static_cast<int>(i)) continue;
      if (LineToBox(from, plan.nodes[j].position, box) < keep) return false;
    }
  }
  for (const Box& other : plan.occupied) {
    if (box.exteriorDistance(other) < gap) return false;
  }
  return true;
}

}  // namespace simulation
}  // namespace cartographer_ext
