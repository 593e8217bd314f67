// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/offline/noise/loops_by_chance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "cartographer_ext/common/thinned.h"
#include "cartographer_ext/optimization/offline/loop_growth.h"

namespace cartographer_ext {
namespace optimization {
namespace {

constexpr size_t kMaxPredictions = 300;
// Of the right loops.
constexpr double kBeyondGate = 0.01;
// What fits nearly everywhere says nothing.
constexpr double kMostByChance = 0.999;
// Gates at the map beyond which no loop is a matter of noise.
constexpr double kWorthALook = 100.;
// Expected wrong loops in force: with fewer there is none in 19 of 20 graphs.
constexpr double kHardlyAny = 0.05;

// Groups that follow a revisit over more poses than this are several.
constexpr int kStretch = 15;

// Loops in force in a map, and the parts of groups with loops of which the other
// map rejects some.
struct Difference {
  int in_force = 0;
  int parts = 0;
};

Difference Compare(const std::vector<WhitenedEdge>& edges,
                   const std::vector<double>& in,
                   const std::vector<double>& out, const LoopSupport& support) {
  std::set<Part> parts;
  Difference result;
  for (size_t i = 0; i != in.size(); ++i) {
    if (!edges[i].is_loop || in[i] <= 0.5) continue;
    ++result.in_force;
    if (out[i] <= 0.5) parts.insert(PartOf(edges[i], support.group[i]));
  }
  result.parts = parts.size();
  return result;
}

// Length of the path up to each pose, infinite from where odometry has a gap.
std::vector<double> LengthsOfPath(const std::vector<WhitenedEdge>& edges,
                                  const size_t num_poses) {
  std::vector<double> steps(num_poses, std::numeric_limits<double>::infinity());
  for (const WhitenedEdge& edge : edges) {
    if (edge.is_loop || std::abs(edge.from - edge.to) != 1) continue;
    steps[std::max(edge.from, edge.to)] = edge.measurement.head<2>().norm();
  }
  std::vector<double> result(num_poses, 0.);
  for (size_t i = 1; i < num_poses; ++i) result[i] = result[i - 1] + steps[i];
  return result;
}

// Logarithm of the area (square metres) that a wrong loop may lead to.
class AreaOfLoops {
 public:
  AreaOfLoops(const std::vector<WhitenedEdge>& edges,
              const std::vector<Pose2>& poses)
      : log_area_(LogArea(poses)),
        lengths_(LengthsOfPath(edges, poses.size())) {}

  double LogOf(const WhitenedEdge& loop) const {
    // Nothing is farther apart than the path between both ends.
    const double length = std::abs(lengths_[loop.from] - lengths_[loop.to]);
    return std::isfinite(length)
               ? std::min(log_area_, std::log(kPi * length * length))
               : log_area_;
  }

 private:
  const double log_area_;
  const std::vector<double> lengths_;
};

// What fits of the groups with loops that `map` rejects if they are wrong: for
// one loop of each, evenly thinned, the probability to lie within the gate;
// `share` is that of the parts.
std::vector<double> Chances(const DecidedMap& map, const LoopSupport& support,
                            RobustSolver* const solver, double* const share) {
  std::vector<int> loops;
  std::set<Part> parts;
  const std::vector<WhitenedEdge>& edges = solver->edges();
  for (size_t i = 0; i != map.decisions.size(); ++i) {
    if (map.decisions[i] > 0.5) continue;
    if (parts.insert(PartOf(edges[i], support.group[i])).second) {
      loops.push_back(i);
    }
  }
  const std::vector<int> looked_at = Thinned(loops, kMaxPredictions);
  *share = loops.empty() ? 1. : 1. * looked_at.size() / loops.size();
  const AreaOfLoops area(edges, map.poses);
  const std::vector<Innovation> innovations =
      PredictLoops(looked_at, map.decisions, map.poses, solver);
  std::vector<double> result;
  for (size_t k = 0; k != innovations.size(); ++k) {
    const WhitenedEdge& edge = edges[looked_at[k]];
    result.push_back(ChanceToFit(edge, area.LogOf(edge), kChi2Gate,
                                 innovations[k].log_determinant));
  }
  return result;
}

// Of one loop of each part that is in force in the map and that `narrower` rejects:
// the logarithm of the odds that they are as noisy as claimed, against wrong ones all
// over the gate g. With the squared innovation c of each,
//
//   chi2 density(c) / (3/2 sqrt(c) / g^(3/2)) = sqrt(2 / (9 pi)) g^(3/2) exp(-c / 2).
double LogOddsOfNoise(const DecidedMap& map, const DecidedMap& narrower,
                      const LoopSupport& support, RobustSolver* const solver) {
  std::vector<int> rejected;
  std::set<Part> parts;
  const std::vector<WhitenedEdge>& edges = solver->edges();
  for (size_t i = 0; i != edges.size(); ++i) {
    if (map.decisions[i] > 0.5 && narrower.decisions[i] <= 0.5 &&
        parts.insert(PartOf(edges[i], support.group[i])).second) {
      rejected.push_back(i);
    }
  }
  const double of_none =
      0.5 * std::log(2. / (9. * kPi)) + 1.5 * std::log(kChi2Gate);
  double result = 0.;
  for (const Innovation& innovation :
       PredictLoops(Thinned(rejected, kMaxPredictions), narrower.decisions,
                    narrower.poses, solver)) {
    result += of_none - 0.5 * std::min(kChi2Gate, innovation.chi2);
  }
  return result;
}

}  // namespace

Part PartOf(const WhitenedEdge& loop, const int group) {
  return {group, std::max(loop.from, loop.to) / kStretch};
}

double WrongInForce(const DecidedMap& map, const LoopSupport& support,
                    RobustSolver* const solver) {
  double result = 0., share = 1.;
  for (const double chance : Chances(map, support, solver, &share)) {
    // Those that fit to each one that does not.
    const double p = std::min(kMostByChance, chance);
    result += p / (1. - p);
  }
  return result / share;
}

bool TakesInMoreThanByChance(const DecidedMap& map, const DecidedMap& wider,
                             const LoopSupport& support,
                             RobustSolver* const solver) {
  const Difference difference =
      Compare(solver->edges(), wider.decisions, map.decisions, support);
  double share = 1., expected = kBeyondGate * difference.in_force;
  for (const double chance : Chances(map, support, solver, &share)) {
    expected += chance / share;
  }
  return difference.parts >= MoreThanExpected(expected);
}

NarrowedMap::NarrowedMap(const DecidedMap& map, const DecidedMap& narrower,
                         const LoopSupport& support,
                         RobustSolver* const solver) {
  const Difference difference =
      Compare(solver->edges(), map.decisions, narrower.decisions, support);
  in_force_ = difference.in_force;
  parts_ = difference.parts;
  if (parts_ == 0) return;
  wrong_in_force_ = WrongInForce(narrower, support, solver);
  log_odds_ = LogOddsOfNoise(map, narrower, support, solver);
}

bool NarrowedMap::RejectsMoreThanByChance() const {
  return log_odds_ > 0. &&
         parts_ >= MoreThanExpected(kBeyondGate * in_force_ + wrong_in_force_);
}

bool NarrowedMap::MayRejectWrongLoops() const {
  return wrong_in_force_ > kHardlyAny;
}

std::vector<int> FindHeavyTail(const DecidedMap& map, const double claimed,
                               const LoopSupport& support,
                               const std::vector<WhitenedEdge>& edges) {
  std::vector<WhitenedEdge> as_claimed = edges;
  std::vector<int> rejected;
  std::set<int> groups, within;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (map.decisions[i] > 0.5) continue;
    WhitenedEdge& edge = as_claimed[i];
    edge.whitening /= claimed;
    groups.insert(support.group[i]);
    if (Chi2(edge, map.poses[edge.from], map.poses[edge.to]) <
        kWorthALook * kChi2Gate) {
      rejected.push_back(i);
    }
  }
  if (rejected.empty()) return {};
  RobustSolver solver(as_claimed);
  const std::vector<Innovation> innovations =
      PredictLoops(rejected, map.decisions, map.poses, &solver);
  for (size_t k = 0; k != innovations.size(); ++k) {
    if (innovations[k].chi2 < kChi2Gate) {
      within.insert(support.group[rejected[k]]);
    }
  }
  if (within.empty()) return {};
  double share = 1., expected = 0.;
  for (const double chance : Chances(map, support, &solver, &share)) {
    expected += chance / share;
  }
  if (within.size() < MoreThanExpected(expected)) return {};
  const double log_odds = std::log((within.size() - expected) /
                                   (groups.size() - within.size() + expected));
  const AreaOfLoops area(edges, map.poses);
  std::vector<int> result;
  for (size_t k = 0; k != innovations.size(); ++k) {
    const WhitenedEdge& edge = as_claimed[rejected[k]];
    if (innovations[k].chi2 < kChi2Gate &&
        LogEvidence(edge, innovations[k], area.LogOf(edge)) + log_odds > 0.) {
      result.push_back(rejected[k]);
    }
  }
  return result;
}

bool RejectsFew(const std::vector<WhitenedEdge>& edges,
                const std::vector<double>& decisions,
                const std::vector<double>& others) {
  int in_force = 0, rejected = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop || decisions[i] <= 0.5) continue;
    ++in_force;
    rejected += others[i] <= 0.5;
  }
  return rejected < MoreThanExpected(kBeyondGate * in_force);
}

double MoreThanExpected(const double expected) {
  constexpr double kMany = 10.;  // nearly normally distributed
  if (expected > kMany) return expected + 3. * std::sqrt(expected) + 2.;
  double beyond = 1., probability = std::exp(-expected);
  int number = 0;
  while (beyond >= 0.001) {
    beyond -= probability;
    probability *= expected / ++number;
  }
  return number;
}

}  // namespace optimization
}  // namespace cartographer_ext
