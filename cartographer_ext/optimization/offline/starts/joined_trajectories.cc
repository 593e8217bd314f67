// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/joined_trajectories.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Loops between two trajectories that are tried; more are thinned evenly.
constexpr size_t kMaxTrials = 100;
// Widths of the kernels, as multiples of the gate.
constexpr double kWidths[] = {400., 20., 1.};

// Trajectory of each pose: poses that odometry joins. Numbered by first pose.
std::vector<int> TrajectoryOfPoses(const PoseGraph& graph, int* const count) {
  std::vector<int> parent(graph.poses.size());
  for (size_t i = 0; i != parent.size(); ++i) parent[i] = i;
  const auto root = [&](int i) {
    while (parent[i] != i) {
      parent[i] = parent[parent[i]];
      i = parent[i];
    }
    return i;
  };
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.is_loop) continue;
    const int a = root(edge.from), b = root(edge.to);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<int> result(parent.size());
  *count = 0;
  for (size_t i = 0; i != parent.size(); ++i) {
    const int first = root(i);
    result[i] = first == static_cast<int>(i) ? (*count)++ : result[first];
  }
  return result;
}

class Joiner {
 public:
  Joiner(const PoseGraph& graph, const SmootherOptions& options)
      : graph_(graph), options_(options), edges_(Whiten(graph.edges)) {
    trajectories_ = TrajectoryOfPoses(graph, &count_);
  }

  bool Join(std::vector<Pose2>* const poses) {
    if (count_ < 2) return false;
    poses_ = graph_.poses;
    edge_weights_.assign(edges_.size(), 1.);
    for (int k = 0; k != count_; ++k) ReplayTrajectory(k);
    placed_.assign(count_, false);
    placed_[0] = true;
    while (PlaceNext()) {
    }
    SolverOptions solver;
    solver.kernel = DefaultKernel(KernelType::kDcs);
    solver.cost_tolerance = 1e-4;
    solver.edge_weights = edge_weights_;
    RobustSolver robust(edges_);
    for (const double width : kWidths) {
      solver.kernel.parameter = width * options_.gate;
      robust.Solve(solver, &poses_);
    }
    *poses = poses_;
    return true;
  }

 private:
  // Replays a trajectory by itself and leaves out the loops found wrong.
  void ReplayTrajectory(const int trajectory) {
    PoseGraph own;
    std::vector<int> number(graph_.poses.size(), -1), original, edges;
    for (size_t i = 0; i != graph_.poses.size(); ++i) {
      if (trajectories_[i] != trajectory) continue;
      number[i] = own.poses.size();
      original.push_back(i);
      own.poses.push_back(graph_.poses[i]);
      own.ids.push_back(graph_.ids[i]);
    }
    for (size_t i = 0; i != graph_.edges.size(); ++i) {
      PoseGraphEdge edge = graph_.edges[i];
      edge.from = number[edge.from];
      edge.to = number[edge.to];
      if (edge.from < 0 || edge.to < 0) continue;
      own.edges.push_back(edge);
      edges.push_back(i);
    }
    ReplayResult replay;
    if (Replay(own, options_, &replay).ok()) {
      for (size_t i = 0; i != edges.size(); ++i) {
        if (!replay.accepted[i]) edge_weights_[edges[i]] = 0.;
      }
    } else {
      replay.poses = DeadReckoning(own);
    }
    for (size_t i = 0; i != original.size(); ++i) {
      poses_[original[i]] = replay.poses[i];
    }
  }

  bool IsPlaced(const int pose) const { return placed_[trajectories_[pose]]; }

  // Places one more trajectory; false when no loop leads to any.
  bool PlaceNext() {
    std::vector<std::vector<int>> loops(count_);
    for (size_t i = 0; i != edges_.size(); ++i) {
      const WhitenedEdge& edge = edges_[i];
      if (IsPlaced(edge.from) == IsPlaced(edge.to)) continue;
      loops[trajectories_[IsPlaced(edge.from) ? edge.to : edge.from]].push_back(
          i);
    }
    const auto most = std::max_element(
        loops.begin(), loops.end(),
        [](const std::vector<int>& a, const std::vector<int>& b) {
          return a.size() < b.size();
        });
    if (most->empty()) return false;
    Pose2 best_motion;
    int best_loop = -1;
    double lowest = std::numeric_limits<double>::infinity();
    const size_t trials = std::min(most->size(), kMaxTrials);
    for (size_t k = 0; k != trials; ++k) {
      const int loop = (*most)[k * most->size() / trials];
      const PoseGraphEdge& edge = graph_.edges[loop];
      const Pose2 motion =
          IsPlaced(edge.from)
              ? poses_[edge.from] * edge.measurement * poses_[edge.to].Inverse()
              : poses_[edge.to] * edge.measurement.Inverse() *
                    poses_[edge.from].Inverse();
      const double contradiction = Contradiction(*most, motion);
      if (contradiction >= lowest) continue;
      lowest = contradiction;
      best_motion = motion;
      best_loop = loop;
    }
    if (best_loop < 0) return false;
    const int trajectory = most - loops.begin();
    for (size_t i = 0; i != poses_.size(); ++i) {
      if (trajectories_[i] == trajectory) poses_[i] = best_motion * poses_[i];
    }
    placed_[trajectory] = true;
    edges_[best_loop].is_loop = false;
    return true;
  }

  // Of these loops, with what is not yet placed moved.
  double Contradiction(const std::vector<int>& loops,
                       const Pose2& motion) const {
    const auto moved = [&](const int pose) {
      return IsPlaced(pose) ? poses_[pose] : motion * poses_[pose];
    };
    double sum = 0.;
    for (const int i : loops) {
      sum += std::log1p(
          Chi2(edges_[i], moved(edges_[i].from), moved(edges_[i].to)));
    }
    return sum;
  }

  const PoseGraph& graph_;
  const SmootherOptions& options_;
  std::vector<WhitenedEdge> edges_;
  std::vector<int> trajectories_;  // per pose
  int count_ = 0;
  std::vector<Pose2> poses_;
  std::vector<double> edge_weights_;
  std::vector<bool> placed_;  // per trajectory
};

}  // namespace

bool JoinTrajectories(const PoseGraph& graph, const SmootherOptions& options,
                      std::vector<Pose2>* const poses) {
  return Joiner(graph, options).Join(poses);
}

}  // namespace optimization
}  // namespace cartographer_ext
