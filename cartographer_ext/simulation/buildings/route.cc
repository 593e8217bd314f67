// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/buildings/route.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace cartographer_ext {
namespace simulation {
namespace {

// A place on the path: the node, and the one before it (-1 at the start).
using State = std::pair<int, int>;

double Length(const FloorPlan& plan, const int a, const int b) {
  return (plan.nodes[b].position - plan.nodes[a].position).norm();
}

// Appends the shortest path from the last node of `path` to `target`.
bool Continue(const FloorPlan& plan, const int target, const bool turns_back,
              std::vector<int>* path) {
  const State start(path->back(),
                    path->size() < 2 ? -1 : (*path)[path->size() - 2]);
  std::map<State, std::pair<double, State>> best;
  using Entry = std::tuple<double, State, State>;  // length, here, from
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> open;
  open.emplace(0., start, State(-1, -1));
  while (!open.empty()) {
    const double length = std::get<0>(open.top());
    const State here = std::get<1>(open.top());
    const State from = std::get<2>(open.top());
    open.pop();
    if (!best.emplace(here, std::make_pair(length, from)).second) continue;
    if (here.first == target) {
      std::vector<int> piece;
      for (State state = here; state != start; state = best.at(state).second) {
        piece.push_back(state.first);
      }
      path->insert(path->end(), piece.rbegin(), piece.rend());
      return true;
    }
    for (const int next : plan.nodes[here.first].neighbours) {
      if (next == here.second && !turns_back) continue;
      const State state(next, here.first);
      if (best.count(state) != 0) continue;
      open.emplace(length + Length(plan, here.first, next), state, here);
    }
  }
  return false;
}

}  // namespace

std::vector<int> RouteNodes(const FloorPlan& plan,
                            const RouteOptions& options) {
  std::vector<int> path = {plan.round.front()};
  for (int lap = 0; lap != options.laps; ++lap) {
    for (size_t i = 1; i < plan.round.size(); ++i) {
      if (plan.round[i] == path.back()) continue;
      if (!Continue(plan, plan.round[i], options.turns_back, &path)) return {};
    }
  }
  // Repeats the beginning, which starts where the round ends. A robot that
  // cannot turn back takes the shortest loop that leads into it.
  double left = plan.overlap;
  const size_t end = path.size();
  for (size_t i = 1; i < end && left > 0.; ++i) {
    left -= Length(plan, path[i - 1], path[i]);
    if (!Continue(plan, path[i], options.turns_back, &path)) return {};
  }
  return path;
}

std::vector<Eigen::Vector2d> Waypoints(const FloorPlan& plan,
                                       const std::vector<int>& nodes,
                                       Random* random) {
  constexpr double kBend = 1e-3;  // radians
  constexpr double kSpacing = 5.;
  std::vector<Eigen::Vector2d> bends;
  for (size_t i = 0; i != nodes.size(); ++i) {
    const Eigen::Vector2d& here = plan.nodes[nodes[i]].position;
    if (i > 0 && i + 1 < nodes.size()) {
      const Eigen::Vector2d in = here - bends.back();
      const Eigen::Vector2d out = plan.nodes[nodes[i + 1]].position - here;
      const double cross = in.x() * out.y() - in.y() * out.x();
      if (std::abs(std::atan2(cross, in.dot(out))) < kBend) continue;
    }
    bends.push_back(here);
  }
  std::vector<Eigen::Vector2d> points = {bends.front()};
  for (size_t i = 1; i < bends.size(); ++i) {
    const Eigen::Vector2d step = bends[i] - bends[i - 1];
    const Eigen::Vector2d left =
        Eigen::Vector2d(-step.y(), step.x()).normalized();
    const int pieces = static_cast<int>(step.norm() / kSpacing);
    for (int k = 1; k < pieces; ++k) {
      const double aside = plan.lateral_slack * random->Uniform(-1., 1.);
      points.push_back(bends[i - 1] + (static_cast<double>(k) / pieces) * step +
                       aside * left);
    }
    points.push_back(bends[i]);
  }
  return points;
}

}  // namespace simulation
}  // namespace cartographer_ext
