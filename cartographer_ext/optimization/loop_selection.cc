// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/loop_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cartographer_ext/optimization/incremental_smoother.h"
#include "cartographer_ext/optimization/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPolishRounds = 10;
// Tolerances of the relative decrease of the cost: for starts and decisions by
// a wide margin, and for what is final.
constexpr double kRough = 1e-3;
constexpr double kFine = 1e-5;

// The graph with one trusted edge a vertex to what came before it, the
// strongest, and all loops. Of a vertex that holds others, as a submap its
// nodes, the information of the edges left out goes to its own. Replaying this
// takes a quarter of the time, and the result is only a start.
PoseGraph Skeleton(const PoseGraph& graph) {
  const auto earlier = [](const PoseGraphEdge& edge) {
    return std::min(edge.from, edge.to);
  };
  const auto later = [](const PoseGraphEdge& edge) {
    return std::max(edge.from, edge.to);
  };
  PoseGraph skeleton;
  skeleton.ids = graph.ids;
  skeleton.poses = graph.poses;
  std::vector<int> strongest(graph.poses.size(), -1);
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    const PoseGraphEdge& edge = graph.edges[i];
    if (edge.is_loop) continue;
    int& best = strongest[later(edge)];
    if (best < 0 ||
        edge.information.trace() > graph.edges[best].information.trace()) {
      best = i;
    }
  }
  std::vector<int> kept(graph.poses.size(), -1);
  for (size_t v = 0; v != graph.poses.size(); ++v) {
    if (strongest[v] < 0) continue;
    kept[v] = skeleton.edges.size();
    skeleton.edges.push_back(graph.edges[strongest[v]]);
  }
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    const PoseGraphEdge& edge = graph.edges[i];
    if (edge.is_loop) {
      skeleton.edges.push_back(edge);
    } else if (strongest[later(edge)] != static_cast<int>(i) &&
               kept[earlier(edge)] >= 0) {
      skeleton.edges[kept[earlier(edge)]].information += edge.information;
    }
  }
  return skeleton;
}

class Selector {
 public:
  Selector(const PoseGraph& graph, const std::vector<int>& neighbours,
           const LoopSelectionOptions& options)
      : graph_(graph),
        neighbours_(neighbours),
        options_(options),
        edges_(Whiten(graph.edges)) {}

  LoopSelection Run() {
    LoopSelection selection;
    selection.accepted.assign(edges_.size(), true);
    if (options_.robust_loops && !options_.left_out_before.empty()) {
      for (size_t i = 0; i != edges_.size(); ++i) {
        selection.accepted[i] =
            !edges_[i].is_loop || !options_.left_out_before[i];
      }
    }
    selection.poses = graph_.poses;
    if (!IsConsistent(selection)) {
      SolveAccepted(selection.accepted, kRough, &selection.poses);
    }
    if (options_.robust_loops) {
      if (!IsConsistent(selection)) {
        Improve({graph_.poses, selection.poses}, &selection);
      }
      if (options_.thorough && LeavesOutMany(0.25, selection)) {
        Improve(ThoroughStarts(), &selection);
        if (LeavesOutMany(0.5, selection)) Improve(Replayed(), &selection);
      }
    }
    if (options_.odometry_check) CheckOdometry(&selection);
    selection.chi2 = Chi2OfEdges(edges_, selection.poses);
    return selection;
  }

 private:
  // Whether the loops in force agree with the poses and the others do not.
  bool IsConsistent(const LoopSelection& selection) const {
    for (size_t i = 0; i != edges_.size(); ++i) {
      const WhitenedEdge& edge = edges_[i];
      if (!edge.is_loop) continue;
      const bool agrees = Chi2(edge, selection.poses[edge.from],
                               selection.poses[edge.to]) < options_.gate;
      if (agrees != selection.accepted[i]) return false;
    }
    return true;
  }

  // A folded map loses many loops, a right one only those that are wrong.
  bool LeavesOutMany(const double share, const LoopSelection& selection) const {
    int loops = 0, left_out = 0;
    for (size_t i = 0; i != edges_.size(); ++i) {
      loops += edges_[i].is_loop;
      left_out += !selection.accepted[i];
    }
    return left_out > share * loops;
  }

  // Solves with these edges alone, those out of force at weight 0.
  void SolveAccepted(const std::vector<bool>& accepted,
                     const double cost_tolerance,
                     std::vector<Pose2>* const poses) const {
    SolverOptions solver;
    solver.max_iterations = 20;
    solver.cost_tolerance = cost_tolerance;
    solver.edge_weights.assign(edges_.size(), 1.);
    for (size_t i = 0; i != edges_.size(); ++i) {
      if (!accepted[i]) solver.edge_weights[i] = 0.;
    }
    solver_.Solve(solver, poses);
  }

  std::vector<std::vector<Pose2>> ThoroughStarts() const {
    std::vector<std::vector<Pose2>> starts = {graph_.poses};
    SolveAccepted(std::vector<bool>(edges_.size(), true), kRough,
                  &starts.back());
    starts.push_back(graph_.poses);
    GncOptions gnc;
    gnc.truncation = options_.gate;
    SolveGnc(gnc, &solver_, &starts.back(), nullptr);
    return starts;
  }

  std::vector<std::vector<Pose2>> Replayed() const {
    ReplayResult replay;
    if (!Replay(Skeleton(graph_), SmootherOptions(), &replay).ok()) return {};
    return {replay.poses};
  }

  // Takes the best that DCS finds from `starts`, if it is better than
  // `selection` or that is no decision of the gate.
  void Improve(const std::vector<std::vector<Pose2>>& starts,
               LoopSelection* const selection) const {
    double lowest = IsConsistent(*selection)
                        ? TruncatedCost(edges_, selection->poses)
                        : std::numeric_limits<double>::infinity();
    std::vector<double> seen;
    for (const std::vector<Pose2>& start : starts) {
      std::vector<Pose2> poses = start;
      SolverOptions solver;
      solver.kernel = DefaultKernel(KernelType::kDcs);
      solver.kernel.parameter = 0.5 * options_.gate;
      solver.cost_tolerance = kRough;
      solver_.Solve(solver, &poses);
      // Different starts often end at the same place.
      const double rough_cost = TruncatedCost(edges_, poses);
      const auto is_near = [&](const double other) {
        return std::abs(rough_cost - other) < 1e-3 * other;
      };
      if (std::any_of(seen.begin(), seen.end(), is_near)) continue;
      seen.push_back(rough_cost);
      std::vector<double> weights;
      PolishTruncated(options_.gate, kPolishRounds, &solver_, &poses, &weights);
      const double cost = TruncatedCost(edges_, poses);
      if (cost >= lowest) continue;
      lowest = cost;
      selection->poses = std::move(poses);
      for (size_t i = 0; i != edges_.size(); ++i) {
        selection->accepted[i] = weights[i] > 0.5;
      }
    }
  }

  std::vector<int> Violations(const std::vector<Pose2>& poses) const {
    std::vector<int> result;
    for (const int i : neighbours_) {
      const WhitenedEdge& edge = edges_[i];
      if (Chi2(edge, poses[edge.from], poses[edge.to]) >
          options_.odometry_gate) {
        result.push_back(i);
      }
    }
    return result;
  }

  // The accepted loop with the largest chi2 that spans the worst violation.
  int Blame(const std::vector<int>& violations,
            const std::vector<bool>& accepted,
            const std::vector<Pose2>& poses) const {
    int worst = violations.front();
    double worst_chi2 = -1.;
    for (const int i : violations) {
      const double chi2 =
          Chi2(edges_[i], poses[edges_[i].from], poses[edges_[i].to]);
      if (chi2 > worst_chi2) {
        worst_chi2 = chi2;
        worst = i;
      }
    }
    const WhitenedEdge& place = edges_[worst];
    int blamed = -1;
    double largest = -1.;
    for (size_t i = 0; i != edges_.size(); ++i) {
      const WhitenedEdge& edge = edges_[i];
      if (!edge.is_loop || !accepted[i]) continue;
      // Touching it is enough.
      if (std::min(edge.from, edge.to) > std::max(place.from, place.to) ||
          std::max(edge.from, edge.to) < std::min(place.from, place.to)) {
        continue;
      }
      const double chi2 = Chi2(edge, poses[edge.from], poses[edge.to]);
      if (chi2 > largest) {
        largest = chi2;
        blamed = i;
      }
    }
    return blamed;
  }

  // Takes back loops blamed before the culprit was found.
  void Acquit(const size_t num_violations,
              LoopSelection* const selection) const {
    std::vector<int> guilty = selection->blamed;
    for (const int loop : selection->blamed) {
      if (guilty.size() < 2) break;
      std::vector<bool> accepted = selection->accepted;
      accepted[loop] = true;
      std::vector<Pose2> poses = graph_.poses;
      SolveAccepted(accepted, kFine, &poses);
      const WhitenedEdge& edge = edges_[loop];
      if (Violations(poses).size() > num_violations ||
          Chi2(edge, poses[edge.from], poses[edge.to]) >= options_.gate) {
        continue;
      }
      selection->accepted = accepted;
      selection->poses = poses;
      guilty.erase(std::find(guilty.begin(), guilty.end(), loop));
    }
    selection->blamed = guilty;
  }

  void CheckOdometry(LoopSelection* const selection) const {
    std::vector<int> violations = Violations(selection->poses);
    if (violations.empty()) return;
    std::vector<bool> accepted = selection->accepted;
    std::vector<Pose2> bent = selection->poses;
    std::vector<int> blamed;
    std::vector<int> remaining = violations;
    for (int k = 0; k < options_.max_rollbacks && !remaining.empty(); ++k) {
      const int loop = Blame(remaining, accepted, bent);
      if (loop < 0) break;
      accepted[loop] = false;
      blamed.push_back(loop);
      bent = graph_.poses;  // rolled back
      SolveAccepted(accepted, kFine, &bent);
      remaining = Violations(bent);
      if (remaining.size() < violations.size()) {
        violations = remaining;
        selection->accepted = accepted;
        selection->poses = bent;
        selection->blamed = blamed;
      }
    }
    Acquit(violations.size(), selection);
    selection->violations = violations.size();
  }

  const PoseGraph& graph_;
  const std::vector<int>& neighbours_;
  const LoopSelectionOptions& options_;
  const std::vector<WhitenedEdge> edges_;
  mutable RobustSolver solver_{edges_};
};

}  // namespace

LoopSelection SelectLoops(const PoseGraph& graph,
                          const std::vector<int>& neighbours,
                          const LoopSelectionOptions& options) {
  return Selector(graph, neighbours, options).Run();
}

}  // namespace optimization
}  // namespace cartographer_ext
