// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/auto_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/polish_near.h"
#include "cartographer_ext/optimization/offline/starts.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr int kPolishRounds = 30;
// A map that has lost fewer loops than this is not folded.
constexpr int kUnfolded = 20;
constexpr size_t kMaxInnovations = 300;
// Variance factors from which the noise is estimated.
constexpr double kFirstVariances[] = {4., 25.};
constexpr int kMaxNoiseRounds = 8;
// Larger graphs are taken at their word.
constexpr size_t kMaxEdgesForNoise = 100000;
// Factors below this are not worth another metric.
constexpr double kMinScale = 1.15;
// Share of the loops.
constexpr double kNearlyAll = 0.98;
// 99.9 % quantile of chi2 with three degrees of freedom.
constexpr double kWideGate = 16.26623619623813;

// By what odometry and loops have to differ for a metric that has both as they
// are, and the share of its loops that it keeps.
constexpr double kMinRatio = 1.25;
constexpr double kMostly = 0.75;

struct Metric {
  double odometry = 1.;  // factors of the standard deviations
  double loops = 1.;
};

enum class Floor {
  kEach,    // no factor is below one
  kLargest  // the larger one is not
};

std::vector<double> Decisions(const std::vector<WhitenedEdge>& edges,
                              const std::vector<Pose2>& poses,
                              const double gate) {
  std::vector<double> weights = Chi2OfEdges(edges, poses);
  for (size_t i = 0; i != edges.size(); ++i) {
    weights[i] = !edges[i].is_loop || weights[i] < gate ? 1. : 0.;
  }
  return weights;
}

int CountLoops(const std::vector<WhitenedEdge>& edges,
               const std::vector<double>& weights) {
  int result = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    result += edges[i].is_loop && weights[i] > 0.5;
  }
  return result;
}

// Whether right loops seem to lie behind the gate: more loops just beyond it
// than it rejects right ones, and fewer farther out. Wrong loops, which may lead
// anywhere, are three times as many from two to four gates as from one to two.
bool LieBehindGate(const std::vector<double>& weights, const int accepted,
                   Portfolio* const portfolio) {
  std::vector<int> rejected;
  for (size_t i = 0; i != weights.size(); ++i) {
    if (weights[i] == 0.) rejected.push_back(i);
  }
  const double expected = 0.01 * accepted;
  const double many = expected + 3. * std::sqrt(expected) + 2.;
  // More than these have many wrong ones among them.
  if (rejected.size() < many || rejected.size() > 0.5 * accepted) return false;
  int near = 0, far = 0;
  for (const Innovation& innovation : PredictLoops(
           rejected, weights, portfolio->best().poses, portfolio->solver())) {
    const double gates = innovation.chi2 / kChi2Gate;
    near += gates < 2.;
    far += gates >= 2. && gates < 4.;
  }
  return near > many && near > far;
}

// Whether the noise may be larger than the matrices say.
bool IsSuspicious(Portfolio* const portfolio) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const std::vector<Pose2>& poses = portfolio->best().poses;
  const std::vector<double> weights = Decisions(edges, poses, kChi2Gate);
  const int accepted = CountLoops(edges, weights);
  const int loops = CountLoops(edges, std::vector<double>(edges.size(), 1.));
  if (loops < 10) return false;
  if (accepted < 10) return true;
  const NoiseScale noise =
      EstimateNoiseScale(poses, weights, portfolio->solver());
  return noise.odometry.low > 1.1 || noise.loops.low > 1.1 ||
         LieBehindGate(weights, accepted, portfolio) ||
         IsCutByGate(LeaveOneOutInnovations(poses, weights, kMaxInnovations,
                                            portfolio->solver()),
                     kChi2Gate);
}

// Lowest truncated cost of a few solvers in the metric of `graph`.
std::vector<Pose2> SearchShortly(const PoseGraph& graph,
                                 const std::vector<std::vector<Pose2>>& starts,
                                 RobustSolver* const solver) {
  std::vector<Pose2> best = starts.front();
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::vector<Pose2>& start : starts) {
    for (const KernelType type :
         {KernelType::kTruncated, KernelType::kDcs, KernelType::kHuber}) {
      std::vector<Pose2> poses = start;
      if (type != KernelType::kTruncated) {
        SolverOptions options;
        options.kernel = DefaultKernel(type);
        if (type == KernelType::kDcs) options.kernel.parameter = kChi2Gate;
        options.max_iterations = 50;
        options.cost_tolerance = 1e-5;
        solver->Solve(options, &poses);
      }
      PolishTruncated(kChi2Gate, kPolishRounds, solver, &poses, nullptr);
      const double cost = TruncatedCost(solver->edges(), poses);
      if (cost >= lowest) continue;
      lowest = cost;
      best = std::move(poses);
    }
  }
  return best;
}

struct NoiseHypothesis {
  Metric metric;
  std::vector<Pose2> poses;
  bool valid = false;
  int accepted = 0;
};

// A search with a narrower gate than the given one would lose what the given
// one keeps.
Metric WithFloor(const Metric& metric, const Floor floor) {
  if (floor == Floor::kEach) {
    return {std::max(1., metric.odometry), std::max(1., metric.loops)};
  }
  const double larger = std::min(1., std::max(metric.odometry, metric.loops));
  return {metric.odometry / larger, metric.loops / larger};
}

// Alternates between solving in a metric and estimating the metric.
NoiseHypothesis EstimateMetric(const PoseGraph& graph, const Metric& first,
                               const Floor floor,
                               const std::vector<std::vector<Pose2>>& starts) {
  NoiseHypothesis result;
  result.metric = WithFloor(first, floor);
  std::vector<std::vector<Pose2>> all_starts = starts;
  for (int round = 0; round != kMaxNoiseRounds; ++round) {
    const PoseGraph scaled =
        WithNoiseScale(graph, result.metric.odometry, result.metric.loops);
    const std::vector<WhitenedEdge> edges = Whiten(scaled.edges);
    RobustSolver solver(edges);
    if (round == 0) {
      std::vector<Pose2> chordal = starts.front();
      if (RobustChordalPoses(edges, &chordal)) all_starts.push_back(chordal);
    } else {
      all_starts = {result.poses, starts.front()};
    }
    result.poses = SearchShortly(scaled, all_starts, &solver);
    const std::vector<double> weights =
        Decisions(edges, result.poses, kChi2Gate);
    result.accepted = CountLoops(edges, weights);
    const NoiseScale noise = EstimateNoiseScale(result.poses, weights, &solver);
    const Metric next =
        WithFloor({result.metric.odometry * noise.odometry.factor,
                   result.metric.loops * noise.loops.factor},
                  floor);
    const double change =
        std::max(std::abs(std::log(next.odometry / result.metric.odometry)),
                 std::abs(std::log(next.loops / result.metric.loops)));
    if (change < 0.05 || round + 1 == kMaxNoiseRounds) {
      // Matrices that are wrong in shape and not only in scale do not make a
      // chi2; where nearly all loops agree there is nothing to mistake.
      const int loops =
          CountLoops(edges, std::vector<double>(edges.size(), 1.));
      std::vector<double> innovations = LeaveOneOutInnovations(
          result.poses, weights, kMaxInnovations, &solver);
      if (floor == Floor::kLargest) {
        // Both factors may be below what the floor has made of them.
        const double factor =
            std::min(1., std::max(noise.odometry.factor, noise.loops.factor));
        for (double& value : innovations) value /= factor * factor;
      }
      result.valid = change < 0.3 && (result.accepted >= kNearlyAll * loops ||
                                      IsLikeChi2(innovations));
      break;
    }
    result.metric = next;
  }
  return result;
}

// In steps, so that two searches of the same graph measure alike.
double Rounded(const double scale) {
  if (scale < kMinScale && scale > 1. / kMinScale) return 1.;
  return std::exp2(std::round(4. * std::log2(scale)) / 4.);
}

// The noise that explains the graph better than its matrices do; false where
// there is none.
bool FindLargerNoise(const PoseGraph& graph, Portfolio* const portfolio,
                     NoiseHypothesis* const found) {
  if (!IsSuspicious(portfolio)) return false;
  const std::vector<std::vector<Pose2>> starts = {portfolio->best().poses,
                                                  graph.poses};
  found->accepted = CountLoops(
      portfolio->edges(),
      Decisions(portfolio->edges(), portfolio->best().poses, kChi2Gate));
  bool any = false;
  for (const double variance : kFirstVariances) {
    const NoiseHypothesis hypothesis =
        EstimateMetric(graph, {std::sqrt(variance), std::sqrt(variance)},
                       Floor::kEach, starts);
    if (!hypothesis.valid || hypothesis.accepted < found->accepted) continue;
    *found = hypothesis;
    any = true;
  }
  if (!any) return false;
  found->metric.odometry = Rounded(found->metric.odometry);
  found->metric.loops = Rounded(found->metric.loops);
  return found->metric.odometry > 1. || found->metric.loops > 1.;
}

// The metric in which odometry and loops count as they are, where they differ
// in what their matrices claim; false where they do not. `applied` is the
// metric of the portfolio, whose best map has to be explained as well.
bool FindNoiseRatio(const PoseGraph& graph, const Metric& applied,
                    Portfolio* const portfolio, NoiseHypothesis* const found) {
  const std::vector<Pose2>& poses = portfolio->best().poses;
  const std::vector<double> weights =
      Decisions(portfolio->edges(), poses, kChi2Gate);
  const int accepted = CountLoops(portfolio->edges(), weights);
  if (accepted < 10) return false;
  const NoiseScale noise =
      EstimateNoiseScale(poses, weights, portfolio->solver());
  if (noise.loops.high * kMinRatio > noise.odometry.low &&
      noise.odometry.high * kMinRatio > noise.loops.low) {
    return false;
  }
  *found = EstimateMetric(graph,
                          {applied.odometry * noise.odometry.factor,
                           applied.loops * noise.loops.factor},
                          Floor::kLargest, {poses});
  if (!found->valid || found->accepted < kMostly * accepted) return false;
  found->metric.odometry = Rounded(found->metric.odometry);
  found->metric.loops = Rounded(found->metric.loops);
  return found->metric.odometry != applied.odometry ||
         found->metric.loops != applied.loops;
}

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
  result->weights = Decisions(edges, best.poses, kChi2Gate);
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

}  // namespace

AutoResult SearchAutomatically(const PoseGraph& graph,
                               const AutoOptions& options) {
  AutoResult result;
  std::vector<PoseGraph> scaled(2);  // outlive the portfolios
  auto portfolio = absl::make_unique<Portfolio>(graph, options.portfolio);
  portfolio->Run();
  NoiseHypothesis noise;
  const auto search_with_noise = [&](PoseGraph* const with_noise) {
    result.applied_odometry_scale = noise.metric.odometry;
    result.applied_loop_scale = noise.metric.loops;
    *with_noise =
        WithNoiseScale(graph, noise.metric.odometry, noise.metric.loops);
    auto other = absl::make_unique<Portfolio>(*with_noise, options.portfolio);
    other->Run();
    for (const Portfolio::Member& member : portfolio->members()) {
      other->Add(member.name, member.poses);
    }
    other->Add("noise", noise.poses);
    other->Improve();
    portfolio = std::move(other);
  };
  if (options.estimate_noise && graph.edges.size() < kMaxEdgesForNoise) {
    if (FindLargerNoise(graph, portfolio.get(), &noise)) {
      search_with_noise(&scaled[0]);
    }
    const Metric applied{result.applied_odometry_scale,
                         result.applied_loop_scale};
    if (FindNoiseRatio(graph, applied, portfolio.get(), &noise)) {
      search_with_noise(&scaled[1]);
    }
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
