// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What decides about loops: graduated non-convexity, the truncated cost and the
// polish by it.
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Rounds of a polish after which loops are taken to come in one by one.
constexpr int kSlowPolish = 5;

// Solutions that are remembered: polishes from neighbouring maps meet in a few.
constexpr size_t kMaxSolutions = 8;

double WeightedCost(const std::vector<WhitenedEdge>& edges,
                    const std::vector<double>& weights,
                    const std::vector<Pose2>& poses) {
  const std::vector<double> chi2 = Chi2OfEdges(edges, poses);
  return std::inner_product(chi2.begin(), chi2.end(), weights.begin(), 0.);
}

// Solves with a kernel as wide as the gate, and keeps that where it lowers the
// truncated cost.
SolverSummary Soften(const double gate, RobustSolver* const solver,
                     std::vector<Pose2>* const poses) {
  SolverOptions options;
  options.kernel = DefaultKernel(KernelType::kGemanMcClure);
  options.kernel.parameter = gate;
  std::vector<Pose2> softened = *poses;
  const SolverSummary summary = solver->Solve(options, &softened);
  if (TruncatedCost(solver->edges(), softened, gate) <
      TruncatedCost(solver->edges(), *poses, gate)) {
    *poses = std::move(softened);
  }
  return summary;
}

}  // namespace

SolverSummary SolveGnc(const std::vector<WhitenedEdge>& edges,
                       const GncOptions& options,
                       std::vector<Pose2>* const poses,
                       std::vector<double>* const weights) {
  RobustSolver solver(edges);
  return SolveGnc(options, &solver, poses, weights);
}

SolverSummary SolveGnc(const GncOptions& options, RobustSolver* const solver,
                       std::vector<Pose2>* const poses,
                       std::vector<double>* const weights) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  const double start = ThreadCpuSeconds();
  SolverOptions inner;
  inner.max_iterations = options.inner_iterations;
  inner.cost_tolerance = 1e-4;
  inner.edge_weights.assign(edges.size(), 1.);
  const std::vector<Pose2> given = *poses;
  const double c = options.truncation;
  SolverSummary total;
  double mu = -1.;
  if (options.reach > c) {
    mu = c / (options.reach - c);
  } else {
    total = solver->Solve(inner, poses);
  }
  const auto in_time = [&] {
    return ThreadCpuSeconds() - start <= options.max_seconds;
  };
  for (int outer = 0; outer != options.max_outer_iterations && in_time();
       ++outer) {
    const std::vector<double> chi2 = Chi2OfEdges(edges, *poses);
    if (mu < 0.) {
      double largest = 0.;
      for (size_t i = 0; i != edges.size(); ++i) {
        if (edges[i].is_loop) largest = std::max(largest, chi2[i]);
      }
      if (2. * largest <= c) break;  // nothing looks wrong
      mu = c / (2. * largest - c);
    }
    bool binary = true;
    for (size_t i = 0; i != edges.size(); ++i) {
      if (!edges[i].is_loop) continue;
      const double weight = GncTlsWeight(chi2[i], c, mu);
      inner.edge_weights[i] = weight;
      binary = binary && (weight < 1e-4 || weight > 1. - 1e-4);
    }
    if (options.restart) *poses = given;
    const SolverSummary summary = solver->Solve(inner, poses);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.final_cost = summary.final_cost;
    total.factor_blocks = summary.factor_blocks;
    total.converged = binary && mu > 1.;
    if (total.converged) break;
    mu *= options.mu_step;
  }
  if (in_time()) {
    inner.max_iterations = 20;
    inner.cost_tolerance = 1e-12;
    const SolverSummary last = solver->Solve(inner, poses);
    total.iterations += last.iterations;
    total.analyses += last.analyses;
    total.final_cost = last.final_cost;
  } else {
    total.converged = false;
  }
  if (weights != nullptr) *weights = inner.edge_weights;
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

bool RobustSolver::Recall(const std::vector<double>& weights,
                          std::vector<Pose2>* const poses) {
  const auto known = std::find_if(
      solutions_.begin(), solutions_.end(), [&](const Solution& solution) {
        return solution.weights == weights &&
               solution.poses.size() == poses->size();
      });
  if (known == solutions_.end()) return false;
  if (WeightedCost(edges_, weights, known->poses) != known->cost) {
    solutions_.erase(known);
    return false;
  }
  if (!(known->cost <= WeightedCost(edges_, weights, *poses))) return false;
  *poses = known->poses;
  return true;
}

void RobustSolver::Remember(const std::vector<double>& weights,
                            const std::vector<Pose2>& poses) {
  if (solutions_.size() == kMaxSolutions) solutions_.pop_front();
  solutions_.push_back({weights, poses, WeightedCost(edges_, weights, poses)});
}

std::vector<double> DecideLoops(const std::vector<WhitenedEdge>& edges,
                                const std::vector<Pose2>& poses,
                                const double gate) {
  std::vector<double> result = Chi2OfEdges(edges, poses);
  for (size_t i = 0; i != edges.size(); ++i) {
    result[i] = !edges[i].is_loop || result[i] < gate ? 1. : 0.;
  }
  return result;
}

SolverSummary PolishTruncated(const std::vector<WhitenedEdge>& edges,
                              const double gate, const int max_rounds,
                              std::vector<Pose2>* const poses,
                              std::vector<double>* const weights) {
  RobustSolver solver(edges);
  return PolishTruncated(gate, max_rounds, &solver, poses, weights);
}

SolverSummary PolishTruncated(const double gate, const int max_rounds,
                              RobustSolver* const solver,
                              std::vector<Pose2>* const poses,
                              std::vector<double>* const weights) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  const double start = ThreadCpuSeconds();
  SolverSummary total;
  SolverOptions options;
  options.initial_lambda = 1e-8;
  options.max_iterations = 20;
  for (int round = 0; round < max_rounds; ++round) {
    const std::vector<double> decisions = DecideLoops(edges, *poses, gate);
    if (decisions == options.edge_weights) {
      total.converged = true;
      break;
    }
    const bool soften = round == kSlowPolish && round + 1 < max_rounds;
    if (!soften) options.edge_weights = decisions;
    if (!soften && solver->Recall(decisions, poses)) continue;
    const SolverSummary summary =
        soften ? Soften(gate, solver, poses) : solver->Solve(options, poses);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.factor_blocks = summary.factor_blocks;
    if (!soften && summary.converged) solver->Remember(decisions, *poses);
  }
  if (weights != nullptr) *weights = options.edge_weights;
  total.final_cost = TruncatedCost(edges, *poses);
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

double AdaptiveGate(const std::vector<WhitenedEdge>& edges,
                    const std::vector<Pose2>& poses) {
  // Quantiles of chi2 with 3 degrees of freedom.
  constexpr double kMedian = 2.365973884375338;
  constexpr double k98th = 9.837409311192957;
  constexpr double kSafety = 4.;
  std::vector<double> inside;
  for (const WhitenedEdge& edge : edges) {
    if (!edge.is_loop) continue;
    const double chi2 = Chi2(edge, poses[edge.from], poses[edge.to]);
    if (chi2 < kChi2Gate) inside.push_back(chi2);
  }
  // Too few loops say nothing about their scale.
  if (inside.size() < 20) return kChi2Gate;
  std::sort(inside.begin(), inside.end());
  const double scale = std::max(inside[inside.size() / 2] / kMedian,
                                inside[inside.size() * 98 / 100] / k98th);
  return kChi2Gate * std::min(1., kSafety * scale);
}

SolverSummary PolishAdapted(const std::vector<WhitenedEdge>& edges,
                            const int max_rounds,
                            std::vector<Pose2>* const poses,
                            std::vector<double>* const weights) {
  RobustSolver solver(edges);
  return PolishAdapted(max_rounds, &solver, poses, weights);
}

SolverSummary PolishAdapted(const int max_rounds, RobustSolver* const solver,
                            std::vector<Pose2>* const poses,
                            std::vector<double>* const weights) {
  constexpr int kMaxGates = 5;
  const double start = ThreadCpuSeconds();
  SolverSummary total;
  double gate = std::numeric_limits<double>::infinity();
  for (int k = 0; k != kMaxGates; ++k) {
    const double next = AdaptiveGate(solver->edges(), *poses);
    if (next >= 0.99 * gate) break;
    gate = next;
    const SolverSummary summary =
        PolishTruncated(gate, max_rounds, solver, poses, weights);
    total.iterations += summary.iterations;
    total.analyses += summary.analyses;
    total.factor_blocks = summary.factor_blocks;
    total.converged = summary.converged;
    total.final_cost = summary.final_cost;
  }
  total.cpu_seconds = ThreadCpuSeconds() - start;
  return total;
}

double TruncatedCost(const std::vector<WhitenedEdge>& edges,
                     const std::vector<Pose2>& poses, const double gate) {
  const std::vector<double> chi2 = Chi2OfEdges(edges, poses);
  double cost = 0.;
  for (size_t i = 0; i != edges.size(); ++i) {
    cost += edges[i].is_loop ? std::min(chi2[i], gate) : chi2[i];
  }
  return cost;
}

}  // namespace optimization
}  // namespace cartographer_ext
