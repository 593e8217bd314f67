// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/starts/joined_trajectories.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Loops between two trajectories that are tried; more are thinned evenly.
constexpr size_t kMaxTrials = 100;
// Widths of the kernels, as multiples of the gate.
constexpr double kWidths[] = {400., 20., 1.};
// Trajectories that maps are grown with, and places of each that one is grown from:
// a growth may take a second.
constexpr int kMaxGrown = 10;
constexpr size_t kMaxPlaces = 5;
// Standard deviations of what holds trajectories that no loop in force joins to the
// rest: so many extents of the map, and radians.
constexpr double kExtents = 10.;
constexpr double kRadians = 10.;

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
    ReplayAll();
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

  bool Grow(const LoopSupport& support, std::vector<Pose2>* const poses) {
    if (count_ < 2 || count_ > kMaxGrown) return false;
    ReplayAll();
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (JoinsTrajectories(edges_[i])) edge_weights_[i] = 0.;
    }
    TieAll();
    while (GrowNext(support)) {
    }
    *poses = poses_;
    return true;
  }

 private:
  // Where a loop places a trajectory.
  struct Place {
    double contradiction = 0.;
    int loop = 0;
    Pose2 motion;
  };

  void ReplayAll() {
    poses_ = graph_.poses;
    edge_weights_.assign(edges_.size(), 1.);
    for (int k = 0; k != count_; ++k) ReplayTrajectory(k);
    placed_.assign(count_, false);
    placed_[0] = true;
  }

  bool JoinsTrajectories(const WhitenedEdge& edge) const {
    return trajectories_[edge.from] != trajectories_[edge.to];
  }

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

  // The trajectory with the most loops to those that are placed, and these loops;
  // none when no loop leads to any.
  std::vector<int> LoopsOfNext(int* const trajectory) const {
    std::vector<std::vector<int>> loops(count_);
    for (size_t i = 0; i != graph_.edges.size(); ++i) {
      const WhitenedEdge& edge = edges_[i];
      if (!JoinsTrajectories(edge) ||
          IsPlaced(edge.from) == IsPlaced(edge.to)) {
        continue;
      }
      loops[trajectories_[IsPlaced(edge.from) ? edge.to : edge.from]].push_back(
          i);
    }
    const auto most = std::max_element(
        loops.begin(), loops.end(),
        [](const std::vector<int>& a, const std::vector<int>& b) {
          return a.size() < b.size();
        });
    *trajectory = most - loops.begin();
    return *most;
  }

  // Where some of these loops want a trajectory, the least contradicted first.
  std::vector<Place> Places(const std::vector<int>& loops) const {
    std::vector<Place> result;
    const size_t trials = std::min(loops.size(), kMaxTrials);
    for (size_t k = 0; k != trials; ++k) {
      Place place;
      place.loop = loops[k * loops.size() / trials];
      const PoseGraphEdge& edge = graph_.edges[place.loop];
      place.motion =
          IsPlaced(edge.from)
              ? poses_[edge.from] * edge.measurement * poses_[edge.to].Inverse()
              : poses_[edge.to] * edge.measurement.Inverse() *
                    poses_[edge.from].Inverse();
      place.contradiction = Contradiction(loops, place.motion);
      result.push_back(place);
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const Place& a, const Place& b) {
                       return a.contradiction < b.contradiction;
                     });
    return result;
  }

  std::vector<Pose2> Moved(const int trajectory, const Pose2& motion) const {
    std::vector<Pose2> result = poses_;
    for (size_t i = 0; i != result.size(); ++i) {
      if (trajectories_[i] == trajectory) result[i] = motion * result[i];
    }
    return result;
  }

  // Places one more trajectory; false when no loop leads to any.
  bool PlaceNext() {
    int trajectory = 0;
    const std::vector<int> loops = LoopsOfNext(&trajectory);
    if (loops.empty()) return false;
    const Place best = Places(loops).front();
    poses_ = Moved(trajectory, best.motion);
    placed_[trajectory] = true;
    edges_[best.loop].is_loop = false;
    return true;
  }

  // Holds each trajectory where it is, so weakly that any loop moves it, for the
  // system to determine all poses.
  void TieAll() {
    const double extent = std::exp(0.5 * LogArea(poses_));
    const double weak = 1. / (kExtents * extent);
    std::vector<bool> tied(count_, false);
    tied[0] = true;
    for (size_t i = 0; i != poses_.size(); ++i) {
      const int trajectory = trajectories_[i];
      if (tied[trajectory]) continue;
      tied[trajectory] = true;
      const Pose2 place = Between(poses_[0], poses_[i]);
      WhitenedEdge tie;
      tie.from = 0;
      tie.to = i;
      tie.measurement << place.x, place.y, place.theta;
      tie.whitening = Eigen::Vector3d(weak, weak, 1. / kRadians).asDiagonal();
      edges_.push_back(tie);
      edge_weights_.push_back(1.);
    }
  }

  // The same by the lowest cost of the maps that are grown from the places of some
  // loops that do not agree with each other.
  bool GrowNext(const LoopSupport& support) {
    int trajectory = 0;
    const std::vector<int> loops = LoopsOfNext(&trajectory);
    if (loops.empty()) return false;
    placed_[trajectory] = true;
    std::vector<bool> banned(edges_.size(), false);
    for (size_t i = 0; i != graph_.edges.size(); ++i) {
      banned[i] = !IsPlaced(edges_[i].from) || !IsPlaced(edges_[i].to);
    }
    placed_[trajectory] = false;
    std::vector<Pose2> best;
    std::vector<double> best_weights;
    double lowest = std::numeric_limits<double>::infinity();
    std::set<int> groups;
    RobustSolver solver(edges_);
    for (const Place& place : Places(loops)) {
      if (groups.size() == kMaxPlaces) break;
      if (!groups.insert(support.group[place.loop]).second) continue;
      std::vector<Pose2> poses = Moved(trajectory, place.motion);
      std::vector<double> weights = edge_weights_;
      weights[place.loop] = 1.;
      if (!ContinueGrowth(support, GrowthOptions(), banned, &solver, &poses,
                          &weights)) {
        continue;
      }
      const double cost = TruncatedCost(edges_, poses);
      if (cost >= lowest) continue;
      lowest = cost;
      best = std::move(poses);
      best_weights = std::move(weights);
    }
    if (best.empty()) return false;
    poses_ = std::move(best);
    edge_weights_ = std::move(best_weights);
    placed_[trajectory] = true;
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

bool GrowTrajectories(const PoseGraph& graph, const SmootherOptions& options,
                      const LoopSupport& support,
                      std::vector<Pose2>* const poses) {
  return Joiner(graph, options).Grow(support, poses);
}

}  // namespace optimization
}  // namespace cartographer_ext
