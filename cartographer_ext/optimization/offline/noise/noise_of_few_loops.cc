// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The noise of odometry where few loops are in force.
#include <cmath>

#include "cartographer_ext/optimization/offline/loop_growth.h"
#include "cartographer_ext/optimization/offline/noise/noise_metric.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"

namespace cartographer_ext {
namespace optimization {
namespace {

// Factors of the odometry that are tried where there are few loops or few are in
// force, the last ones not with less than ten, and the logarithm of the odds that
// one needs.
constexpr double kFewLoopsScales[] = {1.5, 2., 3., 5., 8.};
constexpr double kLargestOfFew = 3.;
// What a loop may say against itself: nothing is known of where uncertain odometry
// leads before the first one.
constexpr double kFirstOfMany = -10.;
const double kFewLoopsOdds = std::log(1000.);

// Of many loops, the share that has to come in.
constexpr double kMostOfMany = 0.75;

// What few loops say if put in force one by one, the likeliest first, as long as
// that says more than `least`: the logarithm of their density over that of wrong
// ones, which lead anywhere. `map`: the poses and how many were put in force.
double EvidenceOfLoops(const std::vector<WhitenedEdge>& edges,
                       const std::vector<Pose2>& chained, const double least,
                       NoiseHypothesis* const map) {
  RobustSolver solver(edges);
  std::vector<double> weights(edges.size(), 1.);
  std::vector<int> rejected;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (!edges[i].is_loop) continue;
    weights[i] = 0.;
    rejected.push_back(i);
  }
  map->poses = chained;
  map->accepted = 0;
  double result = 0.;
  while (!rejected.empty()) {
    const std::vector<Innovation> innovations =
        PredictLoops(rejected, weights, map->poses, &solver);
    const double log_area = LogArea(map->poses);
    double highest = least;
    size_t best = rejected.size();
    for (size_t k = 0; k != innovations.size(); ++k) {
      if (innovations[k].chi2 >= kChi2Gate) continue;
      const double evidence =
          LogEvidence(edges[rejected[k]], innovations[k], log_area);
      if (evidence <= highest) continue;
      highest = evidence;
      best = k;
    }
    if (best == rejected.size()) break;
    result += highest;
    weights[rejected[best]] = 1.;
    rejected.erase(rejected.begin() + best);
    ++map->accepted;
    SolverOptions options;
    options.edge_weights = weights;
    solver.Solve(options, &map->poses);
  }
  return result;
}

}  // namespace

bool FindNoiseOfFewLoops(const NoiseMetric& applied, const NoiseOfMap& map,
                         Portfolio* const portfolio,
                         NoiseHypothesis* const found) {
  if (map.loops < 2 || map.loops > kFewAccepted || map.accepted >= kMinLoops ||
      map.accepted == map.loops || map.agree_closely) {
    return false;
  }
  const bool few = map.loops < kMinLoops;
  // Of many loops wrong ones that confirm each other may be some.
  const double least = few ? 2. : kMostOfMany * map.loops;
  const double least_said = few ? 0. : kFirstOfMany;
  const std::vector<Pose2> chained = ChainOdometry(portfolio->graph());
  NoiseHypothesis given;
  double highest =
      EvidenceOfLoops(portfolio->edges(), chained, least_said, &given) +
      kFewLoopsOdds;
  found->valid = false;
  for (const double scale : kFewLoopsScales) {
    if (few && scale > kLargestOfFew) break;
    NoiseHypothesis hypothesis;
    const double evidence =
        EvidenceOfLoops(WithNoiseScale(portfolio->edges(), scale, 1.), chained,
                        least_said, &hypothesis) -
        0.5 * std::log2(scale) * std::log2(scale);
    if (evidence <= highest || hypothesis.accepted < least ||
        hypothesis.accepted <= map.accepted) {
      continue;
    }
    highest = evidence;
    *found = hypothesis;
    found->metric = {applied.odometry * scale, applied.loops};
    found->valid = true;
  }
  return found->valid && IsAnother(applied, &found->metric);
}

}  // namespace optimization
}  // namespace cartographer_ext
