// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/auto_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/likeliest_map.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"
#include "cartographer_ext/optimization/offline/polish_near.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A map that has lost fewer loops than this is not folded.
constexpr int kUnfolded = 20;
// Relative difference of the costs of members that are one and the same.
constexpr double kSameOptimum = 1e-9;
// How often one of the right loops of a graph lies beyond the wide gate.
constexpr double kBeyondWideGate = 0.001;
// Loops whose leave-one-out innovation is looked at.
constexpr size_t kMaxInnovations = 100;

// What the result may cost more than the best member, to be nearer to the
// adapted gate: what separates that from the best single solver. That is known
// only where all have taken part; otherwise one that has not may reach the
// lowest. On a graph that is too large for that, few do.
double Slack(const Portfolio& portfolio) {
  const double to_solvers =
      std::max(0., portfolio.lowest_of_solvers() - portfolio.best().cost);
  if (portfolio.ran_all_solvers()) return to_solvers;
  return portfolio.Size() > kMaxGrowthWork ? 0.5 * to_solvers : 0.;
}

// Counts a solution.
void Count(const SolverSummary& summary, AutoResult* const result) {
  result->iterations += summary.iterations;
  result->converged = summary.converged;
}

// Polishes a member with the gate and takes it if it costs less than `lowest`,
// truncated there.
void PolishMember(const double gate, const Portfolio::Member& member,
                  RobustSolver* const solver, double* const lowest,
                  AutoResult* const result) {
  std::vector<Pose2> poses = member.poses;
  std::vector<double> weights;
  Count(PolishTruncated(gate, kFullPolishRounds, solver, &poses, &weights),
        result);
  const double cost = TruncatedCost(solver->edges(), poses, gate);
  if (cost >= *lowest) return;
  *lowest = cost;
  result->poses = std::move(poses);
  result->weights = std::move(weights);
  result->member = member.name;
}

// The members that cost at most `limit` polished with the gate, the lowest cost
// truncated there.
void PolishMembers(const double gate, const double limit,
                   Portfolio* const portfolio, AutoResult* const result) {
  double lowest = kInfinity;
  std::vector<double> polished;
  for (const Portfolio::Member& member : portfolio->members()) {
    if (member.cost > limit) continue;
    const bool again =
        std::any_of(polished.begin(), polished.end(), [&](const double cost) {
          return std::abs(member.cost - cost) <= kSameOptimum * cost;
        });
    if (again) continue;
    polished.push_back(member.cost);
    PolishMember(gate, member, portfolio->solver(), &lowest, result);
  }
}

// Whether a narrower gate rejects right loops of the best map. Where most loops
// agree far better than they claim, so need not all.
bool RejectsRightLoops(const AutoResult& narrower, Portfolio* const portfolio) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const DecidedMap best = {
      portfolio->best().poses,
      DecideLoops(edges, portfolio->best().poses, kChi2Gate)};
  return !RejectsFew(edges, best.decisions, narrower.weights) &&
         NarrowedMap(best, {narrower.poses, narrower.weights},
                     portfolio->support(), portfolio->solver())
             .RejectsMoreThanByChance();
}

// Steps 3 and 4 of the header.
void Decide(const AutoOptions& options, Portfolio* const portfolio,
            AutoResult* const result) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const std::vector<Pose2> best = portfolio->best().poses;
  const double lowest = portfolio->best().cost;
  RobustSolver& solver = *portfolio->solver();
  result->member_cost = lowest;
  const double narrow =
      options.adaptive_gate ? AdaptiveGate(edges, best) : kChi2Gate;
  const bool adaptive =
      narrow < kChi2Gate &&
      ClaimTooMuchNoise(LeaveOneOutInnovations(
          best, DecideLoops(edges, best, kChi2Gate), kMaxInnovations, &solver));
  const double slack = Slack(*portfolio);
  const double most = lowest * (1. + kSameOptimum) + slack;
  const Portfolio::Member& likeliest = LikeliestMember(
      !options.lowest_cost           ? kInfinity
      : portfolio->ran_all_solvers() ? most
                                     : lowest * (1. + kSameOptimum),
      portfolio);
  if (adaptive) {
    PolishMembers(narrow, lowest + kUnfolded * kChi2Gate, portfolio, result);
    Count(PolishAdapted(kFullPolishRounds, &solver, &result->poses,
                        &result->weights),
          result);
  }
  if (!adaptive || RejectsRightLoops(*result, portfolio)) {
    double none = kInfinity;
    PolishMember(kChi2Gate, likeliest, &solver, &none, result);
    return;
  }
  if (!options.lowest_cost || TruncatedCost(edges, result->poses) <= most) {
    return;
  }
  const std::vector<Pose2> adapted = result->poses;
  result->poses = likeliest.poses;
  result->member = likeliest.name;
  result->weights = DecideLoops(edges, likeliest.poses, kChi2Gate);
  Count(PolishNear(edges, adapted, most, &result->poses, &result->weights),
        result);
}

// Share of chi2 with three degrees of freedom beyond a value.
double ShareBeyond(const double chi2) {
  return std::erfc(std::sqrt(0.5 * chi2)) +
         std::sqrt(2. * chi2 / kPi) * std::exp(-0.5 * chi2);
}

// The gate that all of so many right loops pass, but for one graph in a
// thousand.
double WideGate(const size_t loops) {
  double low = kChi2Gate, high = 100.;
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    (ShareBeyond(middle) * loops > kBeyondWideGate ? low : high) = middle;
  }
  return high;
}

// Takes the map of the wide gate: with the `near` loops in force, or what a
// member leads to if that costs less.
void WidenGate(const double gate, const std::vector<int>& near,
               const std::vector<Portfolio::Member>& members,
               RobustSolver* const solver, AutoResult* const result) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  SolverOptions options;
  options.edge_weights = result->weights;
  for (const int i : near) options.edge_weights[i] = 1.;
  Count(solver->Solve(options, &result->poses), result);
  Count(PolishTruncated(gate, kFullPolishRounds, solver, &result->poses,
                        &result->weights),
        result);
  double lowest = TruncatedCost(edges, result->poses, gate);
  for (const Portfolio::Member& member : members) {
    if (TruncatedCost(edges, member.poses, gate) >= lowest) continue;
    PolishMember(gate, member, solver, &lowest, result);
  }
  result->gate = gate;
}

// Decisions by the evidence of each loop are not yet those of the lowest cost: loops
// may be right together, or one once others are in force. Of hardly any that are out.
void LowerCostOfGate(RobustSolver* const solver, AutoResult* const result) {
  double lowest = TruncatedCost(solver->edges(), result->poses, result->gate);
  Portfolio::Member with_all;
  with_all.name = result->member;
  with_all.poses = result->poses;
  SolverOptions options;
  options.edge_weights.assign(solver->edges().size(), 1.);
  Count(solver->Solve(options, &with_all.poses), result);
  PolishMember(result->gate, with_all, solver, &lowest, result);
  FlipOptions flip;
  flip.gate = result->gate;
  if (FlipLoops(flip, solver, &result->poses) > 0) {
    result->weights = DecideLoops(solver->edges(), result->poses, result->gate);
  }
}

// Step 5 where many loops are rejected: nothing where the right ones among them
// are not told from wrong ones, or where the map of the gate that these pass is
// another one.
void AcceptHeavyTail(const NoiseMetric& applied, Portfolio* const portfolio,
                     AutoResult* const result) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  size_t in_force = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) continue;
    if (result->weights[i] > 0.5) {
      ++in_force;
    } else if (Chi2(edges[i], result->poses[edges[i].from],
                    result->poses[edges[i].to]) < kChi2Gate) {
      return;  // the gate is narrower for a reason
    }
  }
  // As noisy as the matrices claim, or where that is too much to tell them from
  // wrong ones, as the largest of so many may be.
  const double largest = std::sqrt(WideGate(in_force) / kChi2Gate);
  const double claimed = std::max(1. / applied.loops, largest);
  const auto find_tail = [&](const double noise) {
    return FindHeavyTail({result->poses, result->weights}, noise,
                         portfolio->support(), edges);
  };
  std::vector<int> tail = find_tail(claimed);
  if (tail.empty() && claimed > largest) tail = find_tail(largest);
  if (tail.empty()) return;
  double gate = kChi2Gate;
  for (const Innovation& innovation : PredictLoops(
           tail, result->weights, result->poses, portfolio->solver())) {
    gate = std::max(gate, innovation.chi2);
  }
  AutoResult wide = *result;
  WidenGate(gate, tail, portfolio->members(), portfolio->solver(), &wide);
  for (size_t i = 0; i != wide.weights.size(); ++i) {
    if (result->weights[i] > 0.5 && wide.weights[i] <= 0.5) return;
  }
  *result = std::move(wide);
}

// An estimate in a search with the factor `applied`, for the given matrices.
void ReferToGivenMatrices(const double applied, ScaleEstimate* const scale) {
  scale->factor *= applied;
  scale->low *= applied;
  scale->high *= applied;
}

// Searches the graph with another noise, from what the last search has found.
std::unique_ptr<Portfolio> SearchWithNoise(const PoseGraph& graph,
                                           const NoiseHypothesis& noise,
                                           const bool anew,
                                           const AutoOptions& options,
                                           const Portfolio& last) {
  auto result = absl::make_unique<Portfolio>(
      WithNoiseScale(graph, noise.metric.odometry, noise.metric.loops),
      options.portfolio);
  std::vector<Portfolio::Member> known = last.members();
  known.push_back({"noise", noise.poses});
  if (anew) {
    result->Run();
    for (const Portfolio::Member& member : known) {
      result->Add(member.name, member.poses);
    }
    result->Improve();
  } else {
    result->Continue(known);
  }
  result->AddSolversOf(last);
  return result;
}

// Steps 1 and 2 of the header; `applied` is the metric of the last search.
std::unique_ptr<Portfolio> Search(const PoseGraph& graph,
                                  const AutoOptions& options,
                                  NoiseMetric* const applied) {
  auto portfolio = absl::make_unique<Portfolio>(graph, options.portfolio);
  portfolio->Run();
  if (!options.estimate_noise || graph.edges.size() >= kMaxEdgesForNoise) {
    return portfolio;
  }
  NoiseOfMap map = MeasureNoise(portfolio.get());
  for (const auto find :
       {&FindLargerNoise, &FindNoiseOfFewLoops, &FindLikelierNoise,
        &FindSmallerNoise, &FindNoiseOfCycles, &FindNoiseRatio}) {
    NoiseHypothesis noise;
    if (!find(*applied, map, portfolio.get(), &noise)) continue;
    // Only where the matrices claim too little is another map to be expected
    // than those that are known.
    const bool anew = find == &FindLargerNoise || find == &FindLikelierNoise;
    portfolio = SearchWithNoise(graph, noise, anew, options, *portfolio);
    *applied = noise.metric;
    map = MeasureNoise(portfolio.get());
  }
  return portfolio;
}

}  // namespace

bool AcceptNearLoops(const std::vector<Portfolio::Member>& members,
                     RobustSolver* const solver, AutoResult* const result) {
  const std::vector<WhitenedEdge>& edges = solver->edges();
  std::vector<int> rejected;
  std::vector<double> in_force(edges.size(), 1.);
  for (size_t i = 0; i != edges.size(); ++i) {
    if (result->weights[i] > 0.5) continue;
    in_force[i] = 0.;
    rejected.push_back(i);
  }
  const size_t loops = CountLoops(edges);
  if (rejected.empty() || rejected.size() > 0.05 * loops + 2.) return false;
  const std::vector<Innovation> innovations =
      PredictLoops(rejected, in_force, result->poses, solver);
  const double gate = WideGate(loops), log_area = LogArea(result->poses);
  std::vector<int> near;
  for (size_t k = 0; k != innovations.size(); ++k) {
    if (innovations[k].chi2 < gate &&
        LogEvidence(edges[rejected[k]], innovations[k], log_area) > 0.) {
      near.push_back(rejected[k]);
    }
  }
  // Where most rejected loops lie farther out, those are outliers, and some of
  // them will be near, too.
  if (near.empty() || 2 * near.size() < rejected.size()) return false;
  WidenGate(gate, near, members, solver, result);
  LowerCostOfGate(solver, result);
  return true;
}

AutoResult SearchAutomatically(const PoseGraph& graph,
                               const AutoOptions& options) {
  AutoResult result;
  NoiseMetric applied;
  const std::unique_ptr<Portfolio> portfolio = Search(graph, options, &applied);
  result.applied_odometry_scale = applied.odometry;
  result.applied_loop_scale = applied.loops;
  result.iterations = portfolio->iterations();
  result.converged = portfolio->converged();
  Decide(options, portfolio.get(), &result);
  if (!AcceptNearLoops(portfolio->members(), portfolio->solver(), &result)) {
    AcceptHeavyTail(applied, portfolio.get(), &result);
  }
  result.accepted.assign(graph.edges.size(), true);
  for (size_t i = 0; i != result.accepted.size(); ++i) {
    result.accepted[i] = result.weights[i] > 0.5;
  }
  result.noise =
      EstimateNoiseScale(result.poses, result.weights, portfolio->solver());
  ReferToGivenMatrices(applied.odometry, &result.noise.odometry);
  ReferToGivenMatrices(applied.loops, &result.noise.loops);
  std::vector<Alternative> alternatives = portfolio->alternatives();
  for (const Portfolio::Member& member : portfolio->members()) {
    alternatives.push_back({member.cost, member.poses});
  }
  const std::vector<Pose2> likelier =
      FindLikelierMap(result.poses, portfolio.get());
  if (!likelier.empty()) {
    alternatives.push_back(
        {TruncatedCost(portfolio->edges(), likelier), likelier, true});
  }
  RivalOptions rivals;
  rivals.gate = result.gate;
  result.rivals =
      FindRivalSets(result.poses, alternatives, rivals, portfolio->solver());
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
