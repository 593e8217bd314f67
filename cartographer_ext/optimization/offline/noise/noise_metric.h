// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The metric of a search: factors on the standard deviations of odometry and of
// loops. If the map of a portfolio shows that the information matrices are
// overconfident, or that one of odometry and loops is overconfident relative to
// the other, solving in a metric and estimating the metric (noise_scale.h)
// alternate until both agree.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_NOISE_METRIC_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_NOISE_METRIC_H_

#include <vector>

#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "cartographer_ext/optimization/offline/portfolio.h"

namespace cartographer_ext {
namespace optimization {

// Fewer loops say nothing about the noise by their residuals.
constexpr int kMinLoops = 10;
// Larger graphs are taken at their word.
constexpr size_t kMaxEdgesForNoise = 100000;
// So many innovations take next to no time.
constexpr int kFewAccepted = 100;

// Factors on the standard deviations.
struct NoiseMetric {
  double odometry = 1.;  // factors of the standard deviations
  double loops = 1.;
};

// An estimated metric.
struct NoiseHypothesis {
  NoiseMetric metric;
  std::vector<Pose2> poses;  // that the metric was estimated from
  bool valid = false;
  // Whether solving and estimating have led to one and the same metric.
  bool steady = false;
  int accepted = 0;  // loops
};

// Upper bound of a factor from which a smaller noise is looked into.
constexpr double kSmaller = 0.9;

// The noise of a graph according to the best map of a portfolio.
struct NoiseOfMap {
  std::vector<double> decisions;  // per edge
  int loops = 0;
  int accepted = 0;
  NoiseScale scale;  // where ten loops are accepted
  // Fewer are, and agree so closely that the noise is not larger than claimed: with a
  // larger one wrong loops would come in.
  bool agree_closely = false;
};

// Rounds a metric, so that two searches of the same graph measure alike, and
// returns whether it differs from that applied.
bool IsAnother(const NoiseMetric& applied, NoiseMetric* metric);

// Whether what is lost with a metric that makes the gate narrower speaks against
// it: right loops, or nothing that may be wrong.
bool LosesRightLoops(const NoiseMetric& applied, const NoiseOfMap& map,
                     const NoiseHypothesis& hypothesis, Portfolio* portfolio);

// Measures the noise of the best map of a portfolio.
NoiseOfMap MeasureNoise(Portfolio* portfolio);

// Each finds a noise of the graph that differs in its way from `applied`, the
// metric of the portfolio; false if there is none. `map` is that of the portfolio.
// In the order in which `auto` asks:

// Larger than the matrices of the graph claim: a noise that explains the loops
// better. Only where these are applied as they are. Innovations have to look like
// chi2, unless more loops come into a map of most of them than fit by chance
// (loops_by_chance.h): loops that were measured several times over agree better
// than one factor can say.
bool FindLargerNoise(const NoiseMetric& applied, const NoiseOfMap& map,
                     Portfolio* portfolio, NoiseHypothesis* found);
// The same for the odometry of a graph with fewer than ten loops, whose residuals
// say nothing about it. Two loops and more that confirm each other, far from where
// odometry has led, are hardly wrong ones. With a factor s of the odometry
//
//   log p = sum over loops log N(r; 0, S) V - (log2 s)^2 / 2
//
// where loops are put in force one by one, as in loop_growth.h; it has to exceed
// that of the given noise by odds of 1000, and each loop to be within the gate.
// Also where fewer than ten loops of up to a hundred are in force and three
// quarters of them could be.
bool FindNoiseOfFewLoops(const NoiseMetric& applied, const NoiseOfMap& map,
                         Portfolio* portfolio, NoiseHypothesis* found);
// Larger, up to eight times, where a map with more loops in force is likelier by odds of
// 1000 with it (map_evidence.h) than the best one with the given noise. Asked last of a
// larger noise, in small graphs in which more of the rejected loops would come in with
// the largest than fit by chance.
bool FindLikelierNoise(const NoiseMetric& applied, const NoiseOfMap& map,
                       Portfolio* portfolio, NoiseHypothesis* found);
// Smaller, where another map than the best is likelier by odds of 1000 with it
// (map_evidence.h), each with the noise that it shows itself, not more than is
// claimed. A gate that is too wide lets groups of wrong loops bend odometry that is
// better than it claims. Other maps are those of the portfolio that decide loops
// differently which are not near the gate, and where it has searched groups, what
// short searches with a half to an eighth of the noise find. Where the same map is
// the best in both metrics, the given one is as good. The less noise loops have, the
// more of them are rejected, and those that are left agree ever better: more may not
// be lost than can have been in force by chance. Where no wrong loop is to be
// expected in force, the given noise is good enough.
bool FindSmallerNoise(const NoiseMetric& applied, const NoiseOfMap& map,
                      Portfolio* portfolio, NoiseHypothesis* found);
// Smaller, where loops show less among themselves than is claimed (cycle_noise.h) and
// a map is likelier by odds of 1000 with the noise that it shows than the best one
// with the given noise: another one that a short search finds with the noise of the
// loops, or the best itself without what its gate lets in. Not asked where all solvers
// agree on a map of more than a few loops.
bool FindNoiseOfCycles(const NoiseMetric& applied, const NoiseOfMap& map,
                       Portfolio* portfolio, NoiseHypothesis* found);
// The actual ratio of the noise of odometry and loops, if it differs from that of
// their matrices: by a quarter and three standard deviations. The best map has to be
// explained as well. Or wrong loops in force hide the difference; where the metric
// rejects none that may be wrong, none does.
bool FindNoiseRatio(const NoiseMetric& applied, const NoiseOfMap& map,
                    Portfolio* portfolio, NoiseHypothesis* found);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_NOISE_METRIC_H_
