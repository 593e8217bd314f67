// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A smaller noise than claimed, where it decides between maps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/map_evidence.h"
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"
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
// Logarithm of the odds that another map needs.
const double kMuchLikelier = std::log(1000.);

// A map with the noise that explains it best, with regard to that of the portfolio.
struct ExplainedMap {
  NoiseMetric metric;
  std::vector<Pose2> poses;
  int accepted = 0;
  double evidence = -std::numeric_limits<double>::infinity();
};

// The map with the noise that it shows itself, not more than is claimed.
ExplainedMap Explain(const std::vector<Pose2>& poses, const double log_area,
                     Portfolio* const portfolio) {
  ExplainedMap result, last;
  last.poses = poses;
  for (int round = 0; round != kMaxRounds; ++round) {
    const std::vector<WhitenedEdge> edges = WithNoiseScale(
        portfolio->edges(), last.metric.odometry, last.metric.loops);
    RobustSolver solver(edges);
    std::vector<double> decisions;
    PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &last.poses,
                    &decisions);
    last.accepted = CountLoopsInForce(edges, decisions);
    last.evidence =
        LogEvidenceOfMap({last.poses, decisions}, portfolio->support(),
                         portfolio->edges(), log_area, &solver);
    if (last.evidence > result.evidence) result = last;
    if (last.accepted < kMinLoops) break;
    const NoiseScale noise = EstimateNoiseScale(last.poses, decisions, &solver);
    const NoiseMetric next = {
        std::min(1., last.metric.odometry * noise.odometry.factor),
        std::min(1., last.metric.loops * noise.loops.factor)};
    const double change =
        std::max(std::abs(std::log(next.odometry / last.metric.odometry)),
                 std::abs(std::log(next.loops / last.metric.loops)));
    if (change < kSameNoise) break;
    last.metric = next;
  }
  return result;
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
// with a noise.
std::vector<std::vector<Pose2>> OtherMaps(const Portfolio& portfolio,
                                          const NoiseMetric& metric) {
  const std::vector<WhitenedEdge>& given = portfolio.edges();
  const std::vector<WhitenedEdge> edges =
      WithNoiseScale(given, metric.odometry, metric.loops);
  std::vector<std::pair<double, const Portfolio::Member*>> order;
  for (const Portfolio::Member& member : portfolio.members()) {
    order.push_back({TruncatedCost(edges, member.poses), &member});
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::vector<Pose2>> result;
  for (const auto& entry : order) {
    if (result.size() == kMaxMaps) break;
    AddIfAnother(portfolio, entry.second->poses, &result);
  }
  return result;
}

// Maps that a short search finds with less noise: a gate that is too wide hides
// them from solvers.
void AddMapsOfLessNoise(const Portfolio& portfolio,
                        std::vector<std::vector<Pose2>>* const maps) {
  if (!portfolio.searched_groups()) return;
  const std::vector<Pose2> chained = ChainOdometry(portfolio.graph());
  for (const double factor : kLessNoise) {
    const PoseGraph graph = WithNoiseScale(portfolio.graph(), factor, factor);
    const std::vector<WhitenedEdge> edges = Whiten(graph.edges);
    RobustSolver solver(edges);
    const auto add = [&](std::vector<Pose2> poses) {
      PolishTruncated(kChi2Gate, kFullPolishRounds, &solver, &poses, nullptr);
      AddIfAnother(portfolio, std::move(poses), maps);
    };
    ReplayResult replay;
    if (Replay(graph, SmootherOptions(), &replay).ok()) {
      add(replay.poses);
      if (ReadmitGroups(graph, &replay)) add(replay.poses);
    }
    for (const KernelType type :
         {KernelType::kDcs, KernelType::kGemanMcClure}) {
      SolverOptions options;
      options.kernel = DefaultKernel(type);
      std::vector<Pose2> poses = chained;
      solver.Solve(options, &poses);
      add(std::move(poses));
    }
  }
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
  std::vector<std::vector<Pose2>> others =
      OtherMaps(*portfolio, {std::min(1., map.scale.odometry.factor),
                             std::min(1., map.scale.loops.factor)});
  if (others.empty()) return false;
  AddMapsOfLessNoise(*portfolio, &others);
  const double log_area = LogArea(portfolio->best().poses);
  ExplainedMap likeliest =
      Explain(portfolio->best().poses, log_area, portfolio);
  likeliest.evidence += kMuchLikelier;
  found->valid = false;
  for (const std::vector<Pose2>& other : others) {
    ExplainedMap explained = Explain(other, log_area, portfolio);
    if (explained.evidence <= likeliest.evidence ||
        explained.accepted < kMinLoops ||
        DifferNearGateOnly(edges, explained.poses, portfolio->best().poses)) {
      continue;
    }
    likeliest = std::move(explained);
    found->valid = true;
  }
  if (!found->valid) return false;
  found->metric = {applied.odometry * likeliest.metric.odometry,
                   applied.loops * likeliest.metric.loops};
  found->poses = std::move(likeliest.poses);
  found->accepted = likeliest.accepted;
  return IsAnother(applied, &found->metric) &&
         !LosesRightLoops(applied, map, *found, portfolio);
}

}  // namespace optimization
}  // namespace cartographer_ext
