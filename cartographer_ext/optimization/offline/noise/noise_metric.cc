// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cartographer_ext/common/squared.h"
#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kMaxInnovations = 300;
// Variance factors from which the noise is estimated.
constexpr double kFirstVariances[] = {4., 25.};
constexpr int kMaxNoiseRounds = 8;
// Factors below this are not worth another metric.
constexpr double kMinScale = 1.15;
// Lower bound of a factor from which the matrices are doubted.
constexpr double kDoubtful = 1.1;
// Share of the loops.
constexpr double kNearlyAll = 0.98;
// By what odometry and loops have to differ for a metric that has both as they
// are, in standard deviations, too (one in 740), and the share of its loops that it
// keeps.
constexpr double kMinRatio = 1.25;
constexpr double kSignificant = 3.;
constexpr double kMostly = 0.75;

// Much less than all noise that is claimed.
constexpr double kWellBelow = 0.5;

enum class Floor {
  kEach,    // no factor is below one
  kLargest  // the larger one is not
};

// Whether right loops seem to lie behind the gate: more loops just beyond it
// than it rejects right ones, and fewer farther out. Wrong loops, which may lead
// anywhere, are three times as many from two to four gates as from one to two.
bool LieBehindGate(const std::vector<double>& weights, const int accepted,
                   Portfolio* const portfolio) {
  std::vector<int> rejected;
  for (size_t i = 0; i != weights.size(); ++i) {
    if (weights[i] == 0.) rejected.push_back(i);
  }
  const double many = MoreThanExpected(0.01 * accepted);
  // More than these have many wrong ones among them.
  if (rejected.size() < many || rejected.size() > 0.5 * accepted) return false;
  const std::vector<int> looked_at = Thinned(rejected, kMaxInnovations);
  double near = 0., far = 0.;
  for (const Innovation& innovation : PredictLoops(
           looked_at, weights, portfolio->best().poses, portfolio->solver())) {
    const double gates = innovation.chi2 / kChi2Gate;
    near += gates < 2.;
    far += gates >= 2. && gates < 4.;
  }
  return near * rejected.size() >= many * looked_at.size() && near > far;
}

// Whether the noise may be larger than the matrices say.
bool IsSuspicious(const NoiseOfMap& map, Portfolio* const portfolio) {
  if (map.loops < kMinLoops) return false;
  if (map.accepted < kMinLoops) return !map.agree_closely;
  return map.scale.odometry.low > kDoubtful ||
         map.scale.loops.low > kDoubtful ||
         LieBehindGate(map.decisions, map.accepted, portfolio) ||
         IsCutByGate(
             LeaveOneOutInnovations(portfolio->best().poses, map.decisions,
                                    kMaxInnovations, portfolio->solver()),
             kChi2Gate);
}

// Lowest truncated cost of solutions with these kernels in the metric of the
// solver.
std::vector<Pose2> SearchShortly(const std::vector<KernelType>& kernels,
                                 const std::vector<std::vector<Pose2>>& starts,
                                 RobustSolver* const solver) {
  std::vector<Pose2> best = starts.front();
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::vector<Pose2>& start : starts) {
    for (const KernelType type : kernels) {
      std::vector<Pose2> poses = start;
      if (type != KernelType::kTruncated) {
        SolverOptions options;
        options.kernel = DefaultKernel(type);
        if (type == KernelType::kDcs) options.kernel.parameter = kChi2Gate;
        options.max_iterations = 50;
        options.cost_tolerance = 1e-5;
        solver->Solve(options, &poses);
      }
      PolishTruncated(kChi2Gate, kFullPolishRounds, solver, &poses, nullptr);
      const double cost = TruncatedCost(solver->edges(), poses);
      if (cost >= lowest) continue;
      lowest = cost;
      best = std::move(poses);
    }
  }
  return best;
}

// A search with a narrower gate than the given one would lose what the given
// one keeps.
NoiseMetric WithFloor(const NoiseMetric& metric, const Floor floor) {
  if (floor == Floor::kEach) {
    return {std::max(1., metric.odometry), std::max(1., metric.loops)};
  }
  const double larger = std::min(1., std::max(metric.odometry, metric.loops));
  return {metric.odometry / larger, metric.loops / larger};
}

// How metrics are tried.
struct Trial {
  Floor floor = Floor::kEach;
  std::vector<std::vector<Pose2>> starts;
  // With starts and kernels that keep all loops in their equations, which brings
  // back what a narrower gate has lost.
  bool all_loops = false;
};

// Alternates between solving in a metric and estimating the metric.
NoiseHypothesis EstimateMetric(const std::vector<WhitenedEdge>& given,
                               const NoiseMetric& first, const Trial& trial) {
  const Floor floor = trial.floor;
  std::vector<KernelType> kernels = {KernelType::kTruncated, KernelType::kDcs};
  if (trial.all_loops) kernels.push_back(KernelType::kHuber);
  NoiseHypothesis result;
  result.metric = WithFloor(first, floor);
  std::vector<std::vector<Pose2>> starts = trial.starts;
  for (int round = 0; round != kMaxNoiseRounds; ++round) {
    const std::vector<WhitenedEdge> edges =
        WithNoiseScale(given, result.metric.odometry, result.metric.loops);
    RobustSolver solver(edges);
    if (round > 0) {
      starts = {result.poses, trial.starts.front()};
    } else if (trial.all_loops) {
      std::vector<Pose2> chordal = starts.front();
      if (RobustChordalPoses(edges, &chordal)) starts.push_back(chordal);
    }
    result.poses = SearchShortly(kernels, starts, &solver);
    const std::vector<double> weights =
        DecideLoops(edges, result.poses, kChi2Gate);
    result.accepted = CountLoopsInForce(edges, weights);
    const NoiseScale noise = EstimateNoiseScale(result.poses, weights, &solver);
    const NoiseMetric next =
        WithFloor({result.metric.odometry * noise.odometry.factor,
                   result.metric.loops * noise.loops.factor},
                  floor);
    const double change =
        std::max(std::abs(std::log(next.odometry / result.metric.odometry)),
                 std::abs(std::log(next.loops / result.metric.loops)));
    if (change < 0.05 || round + 1 == kMaxNoiseRounds) {
      // Matrices that are wrong in shape and not only in scale do not make a
      // chi2; where nearly all loops agree there is nothing to mistake.
      const int loops = CountLoops(edges);
      std::vector<double> innovations = LeaveOneOutInnovations(
          result.poses, weights, kMaxInnovations, &solver);
      if (floor == Floor::kLargest) {
        // Both factors may be below what the floor has made of them.
        const double factor =
            std::min(1., std::max(noise.odometry.factor, noise.loops.factor));
        for (double& value : innovations) value /= factor * factor;
      }
      result.steady = change < 0.3;
      result.valid = result.steady && (result.accepted >= kNearlyAll * loops ||
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

// Whether a few loops in force have nearly all chi2, as wrong ones among right
// ones that claim too much noise do.
bool AreMixed(const NoiseOfMap& map, Portfolio* const portfolio) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const std::vector<double> all = Chi2OfEdges(edges, portfolio->best().poses);
  std::vector<double> of_loops;
  double sum = 0.;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop || map.decisions[i] == 0.) continue;
    of_loops.push_back(all[i]);
    sum += all[i];
  }
  return Squared(TypicalNoise(of_loops)) <
         Squared(kWellBelow) * sum / (3. * of_loops.size());
}

// Whether the ratio of two factors is not one, and by enough to matter.
bool Differ(const ScaleEstimate& a, const ScaleEstimate& b) {
  return std::abs(std::log(a.factor / b.factor)) >= std::log(kMinRatio) &&
         std::abs(DeviateOfRatio(a, b)) >= kSignificant;
}

// The map of a metric, given with regard to that of the portfolio.
DecidedMap DecideWith(const Portfolio& portfolio, const NoiseMetric& metric,
                      const std::vector<Pose2>& poses) {
  return {poses, DecideLoops(WithNoiseScale(portfolio.edges(), metric.odometry,
                                            metric.loops),
                             poses, kChi2Gate)};
}

// Whether what comes in with a metric speaks for it, where the map itself says that
// odometry claims too much and most loops are in force already: to a map without
// them groups of wrong ones fit as well.
bool BringsInRightLoops(const NoiseOfMap& map,
                        const NoiseHypothesis& hypothesis,
                        Portfolio* const portfolio) {
  if (!hypothesis.steady || map.accepted < kMinLoops ||
      map.scale.odometry.low <= kDoubtful ||
      map.accepted < kMostly * hypothesis.accepted) {
    return false;
  }
  const std::vector<WhitenedEdge> edges = WithNoiseScale(
      portfolio->edges(), hypothesis.metric.odometry, hypothesis.metric.loops);
  RobustSolver solver(edges);
  return TakesInMoreThanByChance(
      {portfolio->best().poses, map.decisions},
      DecideWith(*portfolio, hypothesis.metric, hypothesis.poses),
      portfolio->support(), &solver);
}

}  // namespace

bool FindLargerNoise(const NoiseMetric& applied, const NoiseOfMap& map,
                     Portfolio* const portfolio, NoiseHypothesis* const found) {
  if (!IsSuspicious(map, portfolio)) return false;
  found->accepted = map.accepted;
  Trial trial;
  trial.starts = {portfolio->best().poses, portfolio->graph().poses};
  trial.all_loops = portfolio->CanKeepAllLoops();
  bool any = false;
  for (const double variance : kFirstVariances) {
    const NoiseHypothesis hypothesis = EstimateMetric(
        portfolio->edges(), {std::sqrt(variance), std::sqrt(variance)}, trial);
    if (hypothesis.accepted < found->accepted ||
        !(hypothesis.valid || BringsInRightLoops(map, hypothesis, portfolio))) {
      continue;
    }
    *found = hypothesis;
    any = true;
  }
  return any && IsAnother(applied, &found->metric);
}

bool FindNoiseRatio(const NoiseMetric& applied, const NoiseOfMap& map,
                    Portfolio* const portfolio, NoiseHypothesis* const found) {
  const NoiseScale& scale = map.scale;
  if (map.accepted < kMinLoops) return false;
  double loops = scale.loops.factor;
  const bool differ = Differ(scale.loops, scale.odometry);
  bool mixed = false;
  if (!differ) {
    // A gate that is too wide lets wrong loops in, which make the noise of the
    // loops look larger than it is.
    if (scale.loops.high >= kSmaller) return false;
    mixed = AreMixed(map, portfolio);
    if (map.accepted > kFewAccepted && !mixed) return false;
    loops = TypicalNoise(LeaveOneOutInnovations(portfolio->best().poses,
                                                map.decisions, kMaxInnovations,
                                                portfolio->solver()));
    if (loops > kWellBelow || loops * kMinRatio > scale.odometry.low) {
      return false;
    }
  }
  Trial trial;
  trial.floor = Floor::kLargest;
  trial.starts = {portfolio->best().poses};
  *found = EstimateMetric(
      WithNoiseScale(portfolio->edges(), 1. / applied.odometry,
                     1. / applied.loops),
      {applied.odometry * scale.odometry.factor, applied.loops * loops}, trial);
  if (!found->valid || found->accepted < kMostly * map.accepted ||
      !IsAnother(applied, &found->metric)) {
    return false;
  }
  // Where no wrong loop is found, none has hidden the ratio.
  return differ || (mixed && found->accepted < map.accepted) ||
         !LosesRightLoops(applied, map, *found, portfolio);
}

bool LosesRightLoops(const NoiseMetric& applied, const NoiseOfMap& map,
                     const NoiseHypothesis& hypothesis,
                     Portfolio* const portfolio) {
  const DecidedMap narrower =
      DecideWith(*portfolio,
                 {hypothesis.metric.odometry / applied.odometry,
                  hypothesis.metric.loops / applied.loops},
                 hypothesis.poses);
  const NarrowedMap narrowed({portfolio->best().poses, map.decisions}, narrower,
                             portfolio->support(), portfolio->solver());
  return !narrowed.MayRejectWrongLoops() ||
         (!RejectsFew(portfolio->edges(), map.decisions, narrower.decisions) &&
          narrowed.RejectsMoreThanByChance());
}

bool IsAnother(const NoiseMetric& applied, NoiseMetric* const metric) {
  metric->odometry = Rounded(metric->odometry);
  metric->loops = Rounded(metric->loops);
  return metric->odometry != applied.odometry || metric->loops != applied.loops;
}

NoiseOfMap MeasureNoise(Portfolio* const portfolio) {
  const std::vector<WhitenedEdge>& edges = portfolio->edges();
  const std::vector<Pose2>& poses = portfolio->best().poses;
  NoiseOfMap result;
  result.decisions = DecideLoops(edges, poses, kChi2Gate);
  result.accepted = CountLoopsInForce(edges, result.decisions);
  result.loops = CountLoops(edges);
  if (result.accepted < kMinLoops) {
    result.agree_closely = IsBelowChi2(LeaveOneOutInnovations(
        poses, result.decisions, kMaxInnovations, portfolio->solver()));
    return result;
  }
  result.scale =
      EstimateNoiseScale(poses, result.decisions, portfolio->solver());
  return result;
}

}  // namespace optimization
}  // namespace cartographer_ext
