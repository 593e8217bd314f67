// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/auto_search.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise_metric.h"
#include "cartographer_ext/optimization/offline/polish_near.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPolishRounds = 30;
// A map that has lost fewer loops than this is not folded.
constexpr int kUnfolded = 20;
// Larger graphs are taken at their word.
constexpr size_t kMaxEdgesForNoise = 100000;
// 99.9 % quantile of chi2 with three degrees of freedom.
constexpr double kWideGate = 16.26623619623813;

// Steps 3 and 4 of the header.
void Decide(const AutoOptions& options, Portfolio* const portfolio,
            AutoResult* const result) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const Portfolio::Member& best = portfolio->best();
  RobustSolver& solver = *portfolio->solver();
  const auto count = [&](const SolverSummary& summary) {
    result->iterations += summary.iterations;
    result->converged = summary.converged;
  };
  result->member_cost = best.cost;
  const double gate =
      options.adaptive_gate ? AdaptiveGate(edges, best.poses) : kChi2Gate;
  const double limit = best.cost + kUnfolded * kChi2Gate;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Portfolio::Member& member : portfolio->members()) {
    if (member.cost > limit || (gate == kChi2Gate && &member != &best)) {
      continue;
    }
    std::vector<Pose2> poses = member.poses;
    std::vector<double> weights;
    count(PolishTruncated(gate, kPolishRounds, &solver, &poses, &weights));
    const double cost = TruncatedCost(edges, poses, gate);
    if (cost >= lowest) continue;
    lowest = cost;
    result->poses = std::move(poses);
    result->weights = std::move(weights);
    result->member = member.name;
  }
  if (!options.adaptive_gate) return;
  count(
      PolishAdapted(kPolishRounds, &solver, &result->poses, &result->weights));
  // Half way to what a solver alone reaches, to stay below others, too.
  const double enough =
      best.cost +
      0.5 * std::max(0., portfolio->lowest_of_solvers() - best.cost);
  if (!options.lowest_cost || TruncatedCost(edges, result->poses) <= enough) {
    return;
  }
  const std::vector<Pose2> adapted = result->poses;
  result->poses = best.poses;
  result->member = best.name;
  result->weights = DecideLoops(edges, best.poses, kChi2Gate);
  count(PolishNear(edges, adapted, enough, &result->poses, &result->weights));
}

// Step 5. A gate of 99 % rejects one right loop in a hundred.
void AcceptNearLoops(Portfolio* const portfolio, AutoResult* const result) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  std::vector<int> rejected;
  std::vector<double> in_force(edges.size(), 1.);
  size_t loops = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    loops += edges[i].is_loop;
    if (result->accepted[i]) continue;
    in_force[i] = 0.;
    rejected.push_back(i);
  }
  if (rejected.empty() || rejected.size() > 0.05 * loops + 2.) return;
  const std::vector<Innovation> innovations =
      PredictLoops(rejected, in_force, result->poses, portfolio->solver());
  std::vector<int> near;
  for (size_t k = 0; k != innovations.size(); ++k) {
    if (innovations[k].chi2 < kWideGate) near.push_back(rejected[k]);
  }
  // Where most rejected loops lie farther out, those are outliers, and some of
  // them will be near, too.
  if (2 * near.size() < rejected.size()) return;
  for (const int i : near) result->accepted[i] = true;
}

// Searches the graph with another noise, which is returned in `scaled`.
std::unique_ptr<Portfolio> SearchWithNoise(const PoseGraph& graph,
                                           const NoiseHypothesis& noise,
                                           const AutoOptions& options,
                                           const Portfolio& last,
                                           const bool whole,
                                           PoseGraph* const scaled) {
  *scaled = WithNoiseScale(graph, noise.metric.odometry, noise.metric.loops);
  auto result = absl::make_unique<Portfolio>(*scaled, options.portfolio);
  std::vector<Portfolio::Member> known = last.members();
  known.push_back({"noise", noise.poses});
  if (whole) {
    result->Run();
    for (const Portfolio::Member& member : known) {
      result->Add(member.name, member.poses);
    }
    result->Improve();
  } else {
    result->Continue(known);
  }
  return result;
}

}  // namespace

AutoResult SearchAutomatically(const PoseGraph& graph,
                               const AutoOptions& options) {
  AutoResult result;
  std::vector<PoseGraph> scaled(2);  // outlive the portfolios
  auto portfolio = absl::make_unique<Portfolio>(graph, options.portfolio);
  portfolio->Run();
  if (options.estimate_noise && graph.edges.size() < kMaxEdgesForNoise) {
    NoiseMetric applied;
    NoiseHypothesis noise;
    NoiseOfMap map = MeasureNoise(portfolio.get());
    if (FindLargerNoise(graph, map, portfolio.get(), &noise)) {
      portfolio = SearchWithNoise(graph, noise, options, *portfolio,
                                  /*whole=*/true, &scaled[0]);
      applied = noise.metric;
      map = MeasureNoise(portfolio.get());
    }
    if (FindNoiseRatio(applied, map, *portfolio, &noise)) {
      // The map is known but for its metric.
      portfolio = SearchWithNoise(graph, noise, options, *portfolio,
                                  /*whole=*/false, &scaled[1]);
      applied = noise.metric;
    }
    result.applied_odometry_scale = applied.odometry;
    result.applied_loop_scale = applied.loops;
  }
  result.iterations = portfolio->iterations();
  result.converged = portfolio->converged();
  Decide(options, portfolio.get(), &result);
  result.accepted.assign(graph.edges.size(), true);
  for (size_t i = 0; i != result.accepted.size(); ++i) {
    result.accepted[i] = result.weights[i] > 0.5;
  }
  result.noise =
      EstimateNoiseScale(result.poses, result.weights, portfolio->solver());
  for (ScaleEstimate* const scale :
       {&result.noise.odometry, &result.noise.loops}) {
    const double applied = scale == &result.noise.odometry
                               ? result.applied_odometry_scale
                               : result.applied_loop_scale;
    scale->factor *= applied;
    scale->low *= applied;
    scale->high *= applied;
  }
  AcceptNearLoops(portfolio.get(), &result);
  std::vector<Alternative> alternatives = portfolio->alternatives();
  for (const Portfolio::Member& member : portfolio->members()) {
    alternatives.push_back({member.cost, member.poses});
  }
  result.undecidable =
      FindRivalSets(portfolio->edges(), portfolio->best().poses,
                    portfolio->best().cost, alternatives, RivalOptions());
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
