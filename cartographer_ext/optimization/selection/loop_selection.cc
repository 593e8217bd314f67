// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/selection/loop_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cartographer_ext/optimization/graph/condensed_graph.h"
#include "cartographer_ext/optimization/graph/stretch_bend.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPolishRounds = 10;
// Share of the loops left out that calls for more starts.
constexpr double kMany = 0.25;
constexpr double kMost = 0.5;
// Longest stretch of the condensed chain.
constexpr int kMaxSteps = 10;
// Of the odometry gate; what is below by the condensed graph and its stretches
// is not looked at in the whole graph, which moves the vertices a little.
constexpr double kSurelyStraight = 0.5;
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

// A folded map loses many loops, a right one only those that are wrong.
bool LeavesOut(const double share, const PoseGraph& graph,
               const std::vector<bool>& accepted) {
  const auto left_out = std::count(accepted.begin(), accepted.end(), false);
  return left_out > share * CountLoops(graph.edges);
}

// What the selection has found so far.
struct State {
  std::vector<bool> accepted;  // per edge
  std::vector<Pose2> poses;
  std::vector<int> suspects;
  int violations = 0;
};

class Selector {
 public:
  Selector(const PoseGraph& graph, const LoopSelectionOptions& options)
      : graph_(graph), options_(options), edges_(Whiten(graph.edges)) {}

  // Steps 1 and 2 of the header, beginning with the edges in force of `state`.
  void Select(State* const state) const {
    state->poses = graph_.poses;
    if (!IsConsistent(*state)) {
      SolveAccepted(state->accepted, kRough, &state->poses);
    }
    if (options_.robust_loops) {
      if (!IsConsistent(*state)) Improve({graph_.poses, state->poses}, state);
      if (options_.thorough && LeavesOutMany(kMany, *state)) {
        Improve(ThoroughStarts(), state);
        if (LeavesOutMany(kMost, *state)) Improve(Replayed(), state);
      }
    }
  }

  // Step 3, beginning with the edges in force of `state`.
  void Check(const std::vector<int>& neighbours, State* const state) {
    neighbours_ = neighbours;
    state->poses = graph_.poses;
    SolveAccepted(state->accepted, kFine, &state->poses);
    CheckOdometry(state);
  }

  const std::vector<WhitenedEdge>& edges() const { return edges_; }

 private:
  // Whether the loops in force agree with the poses and the others do not.
  bool IsConsistent(const State& state) const {
    for (size_t i = 0; i != edges_.size(); ++i) {
      const WhitenedEdge& edge = edges_[i];
      if (!edge.is_loop) continue;
      const bool agrees = Chi2(edge, state.poses[edge.from],
                               state.poses[edge.to]) < options_.gate;
      if (agrees != state.accepted[i]) return false;
    }
    return true;
  }

  bool LeavesOutMany(const double share, const State& state) const {
    return LeavesOut(share, graph_, state.accepted);
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
  // `state` or that is no decision of the gate.
  void Improve(const std::vector<std::vector<Pose2>>& starts,
               State* const state) const {
    double lowest = IsConsistent(*state)
                        ? TruncatedCost(edges_, state->poses)
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
      state->poses = std::move(poses);
      for (size_t i = 0; i != edges_.size(); ++i) {
        state->accepted[i] = weights[i] > 0.5;
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
  int FindSuspect(const std::vector<int>& violations,
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
    int suspect = -1;
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
        suspect = i;
      }
    }
    return suspect;
  }

  // Reinstates suspects that a later one explains: those that agree with the
  // graph solved without the others.
  void Reinstate(const size_t num_violations, State* const state) const {
    std::vector<int> suspects = state->suspects;
    for (const int loop : state->suspects) {
      if (suspects.size() < 2) break;
      std::vector<bool> accepted = state->accepted;
      accepted[loop] = true;
      std::vector<Pose2> poses = graph_.poses;
      SolveAccepted(accepted, kFine, &poses);
      const WhitenedEdge& edge = edges_[loop];
      if (Violations(poses).size() > num_violations ||
          Chi2(edge, poses[edge.from], poses[edge.to]) >= options_.gate) {
        continue;
      }
      state->accepted = accepted;
      state->poses = poses;
      suspects.erase(std::find(suspects.begin(), suspects.end(), loop));
    }
    state->suspects = suspects;
  }

  void CheckOdometry(State* const state) const {
    std::vector<int> violations = Violations(state->poses);
    if (violations.empty()) return;
    std::vector<bool> accepted = state->accepted;
    std::vector<Pose2> bent = state->poses;
    std::vector<int> suspects;
    std::vector<int> remaining = violations;
    for (int k = 0; k < options_.max_rollbacks && !remaining.empty(); ++k) {
      const int loop = FindSuspect(remaining, accepted, bent);
      if (loop < 0) break;
      accepted[loop] = false;
      suspects.push_back(loop);
      bent = graph_.poses;  // rolled back
      SolveAccepted(accepted, kFine, &bent);
      remaining = Violations(bent);
      if (remaining.size() < violations.size()) {
        violations = remaining;
        state->accepted = accepted;
        state->poses = bent;
        state->suspects = suspects;
      }
    }
    Reinstate(violations.size(), state);
    state->violations = violations.size();
  }

  const PoseGraph& graph_;
  const LoopSelectionOptions& options_;
  const std::vector<WhitenedEdge> edges_;
  std::vector<int> neighbours_;
  mutable RobustSolver solver_{edges_};
};

// Whether the loops in force agree with the poses and the others do not, no
// motion between neighbouring poses is bent, and no other starts are due.
bool IsSettled(const PoseGraph& graph, const std::vector<int>& neighbours,
               const LoopSelectionOptions& options,
               LoopSelection* const selection) {
  const auto chi2_of = [&](const PoseGraphEdge& edge) {
    return Chi2(Whiten(edge), graph.poses[edge.from], graph.poses[edge.to]);
  };
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    const PoseGraphEdge& edge = graph.edges[i];
    if (!edge.is_loop) continue;
    selection->chi2[i] = chi2_of(edge);
    if ((selection->chi2[i] < options.gate) != selection->accepted[i]) {
      return false;
    }
  }
  if (options.robust_loops && options.thorough &&
      LeavesOut(kMany, graph, selection->accepted)) {
    return false;
  }
  if (!options.odometry_check) return true;
  for (const int i : neighbours) {
    if (chi2_of(graph.edges[i]) > options.odometry_gate) return false;
  }
  return true;
}

// The stretches of which one step may be beyond the gate. A stretch of n steps
// with the whole of its bend in one has n times its chi2 there.
std::vector<int> MaybeBent(const CondensedGraph& condensed,
                           const std::vector<double>& chi2,
                           const LoopSelectionOptions& options) {
  std::vector<int> result;
  for (size_t k = 0; k != condensed.chain.size(); ++k) {
    if (chi2[condensed.chain[k]] * condensed.chain_steps[k] >
        options.odometry_gate) {
      result.push_back(k);
    }
  }
  return result;
}

}  // namespace

LoopSelection SelectLoops(const PoseGraph& graph,
                          const std::vector<int>& neighbours,
                          const LoopSelectionOptions& options) {
  LoopSelection selection;
  selection.accepted.assign(graph.edges.size(), true);
  selection.chi2.assign(graph.edges.size(), 0.);
  if (options.robust_loops && !options.left_out_before.empty()) {
    for (size_t i = 0; i != graph.edges.size(); ++i) {
      selection.accepted[i] =
          !graph.edges[i].is_loop || !options.left_out_before[i];
    }
  }
  if (IsSettled(graph, neighbours, options, &selection)) return selection;
  const CondensedGraph condensed = Condense(graph, neighbours, kMaxSteps);
  const std::vector<int>& loop_of_edge = condensed.loop_of_edge;
  std::vector<bool> accepted(loop_of_edge.size(), true);
  for (size_t i = 0; i != loop_of_edge.size(); ++i) {
    if (loop_of_edge[i] >= 0) accepted[i] = selection.accepted[loop_of_edge[i]];
  }
  const Selector selector(condensed.graph, options);
  State state;
  state.accepted = accepted;
  selector.Select(&state);
  const std::vector<double> chi2 = Chi2OfEdges(selector.edges(), state.poses);
  for (size_t i = 0; i != loop_of_edge.size(); ++i) {
    if (loop_of_edge[i] < 0) continue;
    selection.accepted[loop_of_edge[i]] = state.accepted[i];
    selection.chi2[loop_of_edge[i]] = chi2[i];
  }
  if (!options.odometry_check) return selection;
  const std::vector<int> maybe_bent = MaybeBent(condensed, chi2, options);
  if (maybe_bent.empty() ||
      LargestBend(graph, neighbours, condensed, state.poses, maybe_bent) <
          kSurelyStraight * options.odometry_gate) {
    return selection;
  }
  Selector checker(graph, options);
  state.accepted = selection.accepted;
  checker.Check(neighbours, &state);
  selection.accepted = state.accepted;
  for (const int i : state.suspects) {
    const WhitenedEdge& edge = checker.edges()[i];
    selection.chi2[i] =
        Chi2(edge, state.poses[edge.from], state.poses[edge.to]);
  }
  selection.suspects = state.suspects;
  selection.violations = state.violations;
  return selection;
}

}  // namespace optimization
}  // namespace cartographer_ext
