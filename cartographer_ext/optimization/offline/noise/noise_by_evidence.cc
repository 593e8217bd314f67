// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Another noise than claimed by the evidence of maps: a smaller one where it decides
// between maps, a larger one where it brings rejected loops in.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/cycle_noise.h"
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"
#include "cartographer_ext/optimization/offline/noise/map_evidence.h"
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"
#include "cartographer_ext/optimization/offline/parts/lost_part.h"
#include "cartographer_ext/optimization/offline/readmission.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Maps that are compared with the best, those that cost least with its noise.
constexpr size_t kMaxMaps = 6;
// Factors with which maps are looked for.
constexpr double kLessNoise[] = {0.5, 0.25, 0.125};
// Rounds in which a map is solved with the noise that it shows, and the change of
// a factor that ends them.
constexpr int kMaxRounds = 4;
constexpr double kSameNoise = 0.05;
// Factors, of odometry and of loops, with which rejected loops may come in, of graphs of
// so many loops at least and so many poses times loops at most, and rejected loops that
// are looked at.
constexpr double kMoreNoise[] = {1., 2., 4., 8.};
constexpr int kMinExplained = 5;
constexpr double kMaxSearched = 2.5e5;
constexpr size_t kMaxRejected = 300;
// Logarithm of the odds that another map, or another noise, needs.
const double kMuchLikelier = std::log(1000.);

// A map with the noise that explains it best, with regard to that of the portfolio.
struct ExplainedMap {
  NoiseMetric metric;
  std::vector<Pose2> poses;
  int accepted = 0;
  double evidence = -std::numeric_limits<double>::infinity();
};

// The polished map, or what a kernel as wide as the gate leads to if that costs less:
// what wrong loops have bent keeps right ones out.
std::vector<Pose2> LowestOf(const std::vector<Pose2>& start,
                            RobustSolver* const solver) {
  std::vector<Pose2> result = start, other = start;
  PolishTruncated(kChi2Gate, kFullPolishRounds, solver, &result, nullptr);
  SolverOptions soft;
  soft.kernel = DefaultKernel(KernelType::kGemanMcClure);
  soft.kernel.parameter = kChi2Gate;
  solver->Solve(soft, &other);
  PolishTruncated(kChi2Gate, kFullPolishRounds, solver, &other, nullptr);
  return TruncatedCost(solver->edges(), other) <
                 TruncatedCost(solver->edges(), result)
             ? other
             : result;
}

// How a map is explained.
struct Explanation {
  NoiseMetric first;    // that is looked for on from here
  bool larger = false;  // than claimed, or smaller
  int max_rounds = kMaxRounds;
  bool soft = false;  // with a kernel, which may lead to another map
};

// The map with the noise that it shows itself, as far as that is less than claimed or, if
// it may be larger, more.
ExplainedMap Explain(const std::vector<Pose2>& poses,
                     const Explanation& explanation, const double log_area,
                     Portfolio* const portfolio) {
  ExplainedMap result, last;
  last.poses = poses;
  last.metric = explanation.first;
  for (int round = 0; round != explanation.max_rounds; ++round) {
    const std::vector<WhitenedEdge> edges = WithNoiseScale(
        portfolio->edges(), last.metric.odometry, last.metric.loops);
    RobustSolver solver(edges);
    if (explanation.soft) last.poses = LowestOf(last.poses, &solver);
    std::vector<double> decisions;
    PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &last.poses,
                    &decisions);
    last.accepted = CountLoopsInForce(edges, decisions);
    last.evidence =
        LogEvidenceOfMap({last.poses, decisions}, portfolio->support(),
                         portfolio->edges(), log_area, &solver);
    if (last.evidence > result.evidence) result = last;
    if (last.accepted < kMinLoops || round + 1 == explanation.max_rounds) break;
    const NoiseScale noise = EstimateNoiseScale(last.poses, decisions, &solver);
    const auto limited = [&](const double factor) {
      return explanation.larger ? std::max(1., factor) : std::min(1., factor);
    };
    const NoiseMetric next = {
        limited(last.metric.odometry * noise.odometry.factor),
        limited(last.metric.loops * noise.loops.factor)};
    const double change =
        std::max(std::abs(std::log(next.odometry / last.metric.odometry)),
                 std::abs(std::log(next.loops / last.metric.loops)));
    if (change < kSameNoise) break;
    last.metric = next;
  }
  return result;
}

// The best map with the noise that is claimed.
ExplainedMap ExplainBestAsClaimed(const double log_area,
                                  Portfolio* const portfolio) {
  Explanation claimed;
  claimed.max_rounds = 1;
  return Explain(portfolio->best().poses, claimed, log_area, portfolio);
}

// What the logarithm of the density may gain where the noise is changed to the one
// that the residuals show.
double GainOf(const ScaleEstimate& scale) {
  const double variance = scale.factor * scale.factor;
  return 0.5 * scale.degrees_of_freedom * (variance - 1. - std::log(variance));
}

// Tells folded maps, which need not be explained.
class HopelessMaps {
 public:
  HopelessMaps(const double log_area, Portfolio* const portfolio)
      : log_area_(log_area), portfolio_(*portfolio) {}

  // Whether a map with the noise of a `likelier` one is that much less likely, by odds
  // of 1000 beside what is asked for, that no other noise makes up for it. What differs
  // in a few loops may become one with that.
  bool Contain(const std::vector<Pose2>& map, const ExplainedMap& likelier) {
    UseNoise(likelier.metric);
    std::vector<Pose2> poses = map;
    std::vector<double> decisions;
    PolishTruncated(kChi2Gate, kFullPolishRounds, solver_.get(), &poses,
                    &decisions);
    const double evidence =
        LogEvidenceOfMap({poses, decisions}, portfolio_.support(),
                         portfolio_.edges(), log_area_, solver_.get());
    const NoiseScale noise =
        EstimateNoiseScale(poses, decisions, solver_.get());
    return evidence + GainOf(noise.odometry) + GainOf(noise.loops) <
           likelier.evidence - 2. * kMuchLikelier;
  }

 private:
  // The memory of one solver serves all maps that are judged with the same noise.
  void UseNoise(const NoiseMetric& metric) {
    if (solver_ != nullptr && metric.odometry == metric_.odometry &&
        metric.loops == metric_.loops) {
      return;
    }
    metric_ = metric;
    solver_.reset();
    edges_ = WithNoiseScale(portfolio_.edges(), metric.odometry, metric.loops);
    solver_ = absl::make_unique<RobustSolver>(edges_);
  }

  const double log_area_;
  Portfolio& portfolio_;
  NoiseMetric metric_;
  std::vector<WhitenedEdge> edges_;
  std::unique_ptr<RobustSolver> solver_;
};

// Whether cycles of loops show less noise than is claimed, by odds of a thousand, and
// how much, not more than claimed. Not asked where all solvers agree on a map, but in
// a small graph, where it costs nothing.
bool CyclesShowLess(const NoiseOfMap& map, const Portfolio& portfolio,
                    NoiseMetric* const shown) {
  if (portfolio.Size() > kMaxGrowthWork ||
      !(portfolio.searched_groups() || map.loops <= kFewAccepted)) {
    return false;
  }
  const CycleNoise noise =
      FindCycleNoise(FindLoopCycles(portfolio.graph(), LoopSupportOptions()));
  *shown = {std::min(1., noise.odometry), std::min(1., noise.loops)};
  return noise.log_likelihood > noise.of_given + kMuchLikelier &&
         std::min(shown->odometry, shown->loops) < kSmaller;
}

// Adds a map that is neither the best of the portfolio nor among `maps`.
void AddIfAnother(const Portfolio& portfolio, std::vector<Pose2> poses,
                  std::vector<std::vector<Pose2>>* const maps) {
  const auto is_same = [&](const std::vector<Pose2>& other) {
    return DifferNearGateOnly(portfolio.edges(), poses, other);
  };
  if (is_same(portfolio.best().poses) ||
      std::any_of(maps->begin(), maps->end(), is_same)) {
    return;
  }
  maps->push_back(std::move(poses));
}

// One of each map of the portfolio other than the best, in the order of their costs
// with a noise. Where to explain one takes long, none that has lost a part of the path
// if the best has not.
std::vector<std::vector<Pose2>> OtherMaps(const NoiseMetric& metric,
                                          Portfolio* const portfolio) {
  const std::vector<WhitenedEdge>& given = portfolio->edges();
  const auto has_lost_a_part = [&](const std::vector<Pose2>& poses) {
    return FindLostPart(given, DecideLoops(given, poses, kChi2Gate))
        .has_value();
  };
  const bool lost_count = portfolio->Size() <= kMaxGrowthWork ||
                          has_lost_a_part(portfolio->best().poses);
  const std::vector<WhitenedEdge> edges =
      WithNoiseScale(given, metric.odometry, metric.loops);
  std::vector<std::pair<double, const Portfolio::Member*>> order;
  for (const Portfolio::Member& member : portfolio->members()) {
    order.push_back({TruncatedCost(edges, member.poses), &member});
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::vector<Pose2>> result;
  for (const auto& entry : order) {
    if (result.size() == kMaxMaps) break;
    if (!lost_count && has_lost_a_part(entry.second->poses)) continue;
    AddIfAnother(*portfolio, entry.second->poses, &result);
  }
  return result;
}

// Maps that a short search finds with less noise: a gate that is too wide hides
// them from solvers.
void AddMapsOfLessNoise(const Portfolio& portfolio, const NoiseMetric& metric,
                        std::vector<std::vector<Pose2>>* const maps) {
  const std::vector<Pose2> chained = ChainOdometry(portfolio.graph());
  const PoseGraph graph =
      WithNoiseScale(portfolio.graph(), metric.odometry, metric.loops);
  std::vector<WhitenedEdge> edges = Whiten(graph.edges);
  RobustSolver solver(edges);
  const auto add = [&](std::vector<Pose2> poses) {
    PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &poses, nullptr);
    AddIfAnother(portfolio, std::move(poses), maps);
  };
  ReplayResult replay;
  if (Replay(graph, SmootherOptions(), &replay).ok()) {
    add(replay.poses);
    if (ReadmitGroups(graph, &edges, &solver, &replay)) add(replay.poses);
  }
  for (const KernelType type : {KernelType::kDcs, KernelType::kGemanMcClure}) {
    SolverOptions options;
    options.kernel = DefaultKernel(type);
    std::vector<Pose2> poses = chained;
    solver.Solve(options, &poses);
    add(std::move(poses));
  }
}

// Whether more of the rejected loops than by chance would be within the gate of a map if
// all were as noisy as is looked into.
bool MayBeNoisier(const NoiseOfMap& map, Portfolio* const portfolio) {
  constexpr double kMost = kMoreNoise[3];
  const std::vector<WhitenedEdge> edges =
      WithNoiseScale(portfolio->edges(), kMost, kMost);
  RobustSolver solver(edges);
  std::vector<int> rejected;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (map.decisions[i] <= 0.5) rejected.push_back(i);
  }
  rejected = Thinned(rejected, kMaxRejected);
  const std::vector<Pose2>& poses = portfolio->best().poses;
  const double log_area = LogArea(poses);
  const std::vector<Innovation> innovations =
      PredictLoops(rejected, map.decisions, poses, &solver);
  double within = 0., by_chance = 0.;
  for (size_t k = 0; k != innovations.size(); ++k) {
    within += innovations[k].chi2 < kChi2Gate;
    by_chance += ChanceToFit(edges[rejected[k]], log_area, kChi2Gate,
                             innovations[k].log_determinant);
  }
  return within >= MoreThanExpected(by_chance);
}

// Takes over a map; whether its noise is another.
bool TakeMap(const NoiseMetric& applied, ExplainedMap* const map,
             NoiseHypothesis* const found) {
  found->metric = {applied.odometry * map->metric.odometry,
                   applied.loops * map->metric.loops};
  found->poses = std::move(map->poses);
  found->accepted = map->accepted;
  return IsAnother(applied, &found->metric);
}

// Explains poses, or gives them up in view of the likeliest map so far (no evidence).
using ExplainAgainst =
    std::function<ExplainedMap(const std::vector<Pose2>&, const ExplainedMap&)>;

// Takes over the likeliest of `maps` if it is likelier than the best one by odds of
// 1000, has another noise and loses no right loops to that.
bool TakeLikeliest(const NoiseMetric& applied, const NoiseOfMap& map,
                   const std::vector<std::vector<Pose2>>& maps,
                   ExplainedMap best, const ExplainAgainst& explain,
                   Portfolio* const portfolio, NoiseHypothesis* const found) {
  ExplainedMap likeliest = std::move(best);
  likeliest.evidence += kMuchLikelier;
  found->valid = false;
  for (const std::vector<Pose2>& poses : maps) {
    ExplainedMap explained = explain(poses, likeliest);
    if (explained.evidence <= likeliest.evidence ||
        explained.accepted < kMinLoops) {
      continue;
    }
    likeliest = std::move(explained);
    found->valid = true;
  }
  return found->valid && TakeMap(applied, &likeliest, found) &&
         !LosesRightLoops(applied, map, *found, portfolio);
}

}  // namespace

bool FindSmallerNoise(const NoiseMetric& applied, const NoiseOfMap& map,
                      Portfolio* const portfolio,
                      NoiseHypothesis* const found) {
  if (map.accepted < kMinLoops ||
      std::min(map.scale.odometry.high, map.scale.loops.high) >= kSmaller) {
    return false;
  }
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const std::vector<Pose2>& best = portfolio->best().poses;
  std::vector<std::vector<Pose2>> others =
      OtherMaps({std::min(1., map.scale.odometry.factor),
                 std::min(1., map.scale.loops.factor)},
                portfolio);
  if (others.empty()) return false;
  if (portfolio->searched_groups()) {
    for (const double factor : kLessNoise) {
      AddMapsOfLessNoise(*portfolio, {factor, factor}, &others);
    }
  }
  const double log_area = LogArea(best);
  HopelessMaps hopeless(log_area, portfolio);
  const auto explain = [&](const std::vector<Pose2>& other,
                           const ExplainedMap& likeliest) {
    if (hopeless.Contain(other, likeliest)) return ExplainedMap();
    ExplainedMap explained = Explain(other, {}, log_area, portfolio);
    // Without evidence there are no poses.
    return explained.evidence <= likeliest.evidence ||
                   DifferNearGateOnly(edges, explained.poses, best)
               ? ExplainedMap()
               : explained;
  };
  return TakeLikeliest(applied, map, others,
                       Explain(best, {}, log_area, portfolio), explain,
                       portfolio, found);
}

bool FindNoiseOfCycles(const NoiseMetric& applied, const NoiseOfMap& map,
                       Portfolio* const portfolio,
                       NoiseHypothesis* const found) {
  Explanation explanation;
  explanation.soft = true;
  if (map.accepted < kMinLoops ||
      !CyclesShowLess(map, *portfolio, &explanation.first)) {
    return false;
  }
  const std::vector<Pose2>& best = portfolio->best().poses;
  std::vector<std::vector<Pose2>> maps =
      OtherMaps(explanation.first, portfolio);
  AddMapsOfLessNoise(*portfolio, explanation.first, &maps);
  maps.push_back(best);
  const double log_area = LogArea(best);
  const auto explain = [&](const std::vector<Pose2>& other,
                           const ExplainedMap&) {
    return Explain(other, explanation, log_area, portfolio);
  };
  return TakeLikeliest(applied, map, maps,
                       ExplainBestAsClaimed(log_area, portfolio), explain,
                       portfolio, found);
}

bool FindLikelierNoise(const NoiseMetric& applied, const NoiseOfMap& map,
                       Portfolio* const portfolio,
                       NoiseHypothesis* const found) {
  if (map.loops < kMinExplained || map.accepted == map.loops ||
      map.agree_closely || portfolio->Size() > kMaxSearched ||
      !MayBeNoisier(map, portfolio)) {
    return false;
  }
  const double log_area = LogArea(portfolio->best().poses);
  ExplainedMap likeliest = ExplainBestAsClaimed(log_area, portfolio);
  const double needed = likeliest.evidence + kMuchLikelier;
  likeliest.evidence = needed;
  Explanation explanation;
  explanation.larger = explanation.soft = true;
  const auto try_metric = [&](const NoiseMetric& metric, const int rounds,
                              const std::vector<Pose2>& start) {
    explanation.first = metric;
    explanation.max_rounds = rounds;
    ExplainedMap explained = Explain(start, explanation, log_area, portfolio);
    if (explained.accepted <= map.accepted ||
        explained.evidence <= likeliest.evidence) {
      return;
    }
    likeliest = std::move(explained);
  };
  for (const double odometry : kMoreNoise) {
    for (const double loops : kMoreNoise) {
      if (odometry * loops == 1.) continue;
      for (const auto* const start :
           {&portfolio->best().poses, &portfolio->graph().poses}) {
        try_metric({odometry, loops}, 1, *start);
      }
    }
  }
  if (likeliest.evidence == needed) return false;
  const ExplainedMap first = likeliest;
  try_metric(first.metric, kMaxRounds, first.poses);
  found->valid = true;
  return TakeMap(applied, &likeliest, found);
}

}  // namespace optimization
}  // namespace cartographer_ext
