// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/decision_moves.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "Eigen/Cholesky"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/loop_predictor.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Loops with a chi2 beyond so many gates are not worth a look.
constexpr double kNear = 100.;
// Gates beyond which a loop is rejected in a map that is another one.
constexpr double kDecisive = 4.;
// Relative decrease of the cost that counts.
constexpr double kProgress = 1e-9;

struct Flip {
  int edge = 0;
  double gain = 0.;  // predicted decrease of the truncated cost
};

std::vector<double> Decisions(const std::vector<WhitenedEdge>& edges,
                              const std::vector<double>& chi2,
                              const double gate) {
  std::vector<double> weights(edges.size());
  for (size_t i = 0; i != edges.size(); ++i) {
    weights[i] = !edges[i].is_loop || chi2[i] < gate ? 1. : 0.;
  }
  return weights;
}

// Flips that promise a gain, the best first.
std::vector<Flip> PromisingFlips(const FlipOptions& options,
                                 const std::vector<double>& chi2,
                                 const std::vector<double>& weights,
                                 const std::vector<Pose2>& poses,
                                 RobustSolver* const solver) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  std::vector<std::pair<double, int>> near;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop || chi2[i] > kNear * options.gate ||
        chi2[i] < 0.02 * options.gate) {
      continue;
    }
    near.push_back({std::abs(std::log(chi2[i] / options.gate)), i});
  }
  std::sort(near.begin(), near.end());
  if (static_cast<int>(near.size()) > options.max_loops) {
    near.resize(options.max_loops);
  }
  std::vector<Flip> result;
  if (near.empty()) return result;
  Eigen::VectorXd rhs;
  const BlockLdlt* const factorised = solver->Factor(poses, weights, &rhs);
  if (factorised == nullptr) return result;
  std::vector<int> loops;
  for (const auto& entry : near) loops.push_back(entry.second);
  const std::vector<LoopPrediction> predictions =
      LoopPredictor(edges, poses, *factorised).Predict(loops);
  for (size_t k = 0; k != loops.size(); ++k) {
    const Eigen::Vector3d& residual = predictions[k].residual;
    const bool in_force = weights[loops[k]] > 0.;
    const Eigen::Matrix3d covariance =
        Eigen::Matrix3d::Identity() +
        (in_force ? -1. : 1.) * predictions[k].covariance;
    const Eigen::LLT<Eigen::Matrix3d> root(covariance);
    if (root.info() != Eigen::Success) continue;
    const double cost = residual.dot(root.solve(residual));
    const double gain = in_force ? cost - options.gate : options.gate - cost;
    if (gain > 0.) result.push_back({loops[k], gain});
  }
  std::sort(result.begin(), result.end(), [](const Flip& a, const Flip& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.edge < b.edge;
  });
  return result;
}

// Puts a group in force, releases it and polishes. With `relax` from a chordal
// relaxation of what is in force then; false where there is none, or where the
// map costs more than `limit` while the group is in force.
bool SolveForced(const std::vector<int>& group, const ForceOptions& options,
                 const bool relax, const double limit,
                 std::vector<WhitenedEdge>* const edges,
                 RobustSolver* const solver, std::vector<Pose2>* const poses) {
  const double gate = options.gate;
  SolverOptions robust;
  robust.kernel = DefaultKernel(KernelType::kDcs);
  robust.kernel.parameter = gate;
  robust.cost_tolerance = 1e-4;
  robust.max_iterations = 40;
  for (const int i : group) (*edges)[i].is_loop = false;
  const bool started =
      !relax || ChordalPoses(*edges, DecideLoops(*edges, *poses, gate), poses);
  if (started) solver->Solve(robust, poses);
  for (const int i : group) (*edges)[i].is_loop = true;
  if (!started || TruncatedCost(*edges, *poses, gate) > limit) return false;
  solver->Solve(robust, poses);
  PolishTruncated(gate, kFullPolishRounds, solver, poses, nullptr);
  return true;
}

// The largest group with most of its loops rejected that is not in `tried`, -1 where
// there is none, and how many these are.
int LargestRejected(const LoopSupport& support, const ForceOptions& options,
                    const std::vector<WhitenedEdge>& edges,
                    const std::vector<Pose2>& poses,
                    const std::vector<bool>& tried, size_t* const most) {
  const std::vector<double> chi2 = Chi2OfEdges(edges, poses);
  int result = -1;
  *most = 0;
  for (size_t g = 0; g != support.groups.size(); ++g) {
    if (tried[g]) continue;
    size_t members = 0, rejected = 0;
    for (const int i : support.groups[g]) {
      if (options.part.has_value() && !options.part->IsLeftBy(edges[i])) {
        continue;
      }
      ++members;
      rejected += chi2[i] >= options.gate;
    }
    if (rejected > *most && 2 * rejected >= members &&
        static_cast<int>(rejected) >= options.min_members) {
      *most = rejected;
      result = g;
    }
  }
  return result;
}

}  // namespace

bool DifferNearGateOnly(const std::vector<WhitenedEdge>& edges,
                        const std::vector<Pose2>& a,
                        const std::vector<Pose2>& b) {
  const std::vector<double> in_a = Chi2OfEdges(edges, a);
  const std::vector<double> in_b = Chi2OfEdges(edges, b);
  for (size_t i = 0; i != edges.size(); ++i) {
    if (edges[i].is_loop && std::min(in_a[i], in_b[i]) < kChi2Gate &&
        std::max(in_a[i], in_b[i]) >= kDecisive * kChi2Gate) {
      return false;
    }
  }
  return true;
}

LowestCost::LowestCost(const std::vector<WhitenedEdge>& edges,
                       const double gate, const double progress,
                       std::vector<Pose2>* const poses,
                       std::vector<Alternative>* const alternatives)
    : edges_(edges),
      gate_(gate),
      progress_(progress),
      poses_(*poses),
      alternatives_(alternatives),
      cost_(TruncatedCost(edges, *poses, gate)) {}

bool LowestCost::Offer(std::vector<Pose2> moved) {
  const double moved_cost = TruncatedCost(edges_, moved, gate_);
  const bool better = moved_cost < cost_ * (1. - progress_);
  if (better) std::swap(moved, poses_);
  if (alternatives_ != nullptr && std::abs(moved_cost - cost_) < gate_) {
    alternatives_->push_back({std::max(cost_, moved_cost), std::move(moved)});
  }
  if (better) cost_ = moved_cost;
  return better;
}

int FlipLoops(const FlipOptions& options, RobustSolver* const solver,
              std::vector<Pose2>* const poses) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  int kept = 0, trials = 0;
  std::set<int> tried;
  LowestCost lowest(edges, options.gate, kProgress, poses, nullptr);
  for (bool progress = true; progress && trials < options.max_trials;) {
    progress = false;
    const std::vector<double> chi2 = Chi2OfEdges(edges, *poses);
    const std::vector<double> weights = Decisions(edges, chi2, options.gate);
    for (const Flip& flip :
         PromisingFlips(options, chi2, weights, *poses, solver)) {
      if (!tried.insert(flip.edge).second) continue;
      if (trials++ == options.max_trials) break;
      SolverOptions solve;
      solve.edge_weights = weights;
      solve.edge_weights[flip.edge] = 1. - weights[flip.edge];
      solve.initial_lambda = 1e-8;
      solve.max_iterations = 20;
      std::vector<Pose2> flipped = *poses;
      solver->Solve(solve, &flipped);
      PolishTruncated(options.gate, kFullPolishRounds, solver, &flipped,
                      nullptr);
      if (lowest.Offer(std::move(flipped))) {
        ++kept;
        progress = true;
        break;
      }
    }
  }
  return kept;
}

int ForceGroups(const LoopSupport& support, const ForceOptions& options,
                std::vector<WhitenedEdge>* const edges,
                RobustSolver* const solver, std::vector<Pose2>* const poses,
                std::vector<Alternative>* const alternatives) {
  CHECK_EQ(&solver->edges(), edges);
  LowestCost lowest(*edges, options.gate, kProgress, poses, alternatives);
  int kept = 0, trials = 0;
  std::vector<bool> tried(support.groups.size(), false);
  const double most_work = solver->work() + options.max_work;
  while (trials < options.max_trials && solver->work() < most_work) {
    size_t most;
    const int best =
        LargestRejected(support, options, *edges, *poses, tried, &most);
    if (best < 0) break;
    tried[best] = true;
    ++trials;
    bool better = false;
    for (const bool relax : {false, true}) {
      if (better || (relax && !options.relax)) break;
      std::vector<Pose2> moved = *poses;
      if (!SolveForced(support.groups[best], options, relax,
                       lowest.cost() + options.max_rise * most * options.gate,
                       edges, solver, &moved)) {
        continue;
      }
      better = lowest.Offer(std::move(moved));
    }
    if (!better) continue;
    ++kept;
    // What failed before may succeed now.
    std::fill(tried.begin(), tried.end(), false);
    tried[best] = true;
  }
  return kept;
}

}  // namespace optimization
}  // namespace cartographer_ext
