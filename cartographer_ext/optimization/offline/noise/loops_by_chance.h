// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells right loops from wrong ones that fit by chance where two metrics
// (noise_metric.h) decide them differently. A wrong loop may lead anywhere in the
// map, so the share of wrong ones that lie within the gate g of a prediction with
// covariance S is the volume of that ellipsoid over that of all relative poses,
//
//   p = 4/3 pi g^(3/2) sqrt(det S) / (2 pi A det W).
//
// A group of loops that agree (loop_support.h) fits or does not fit as one.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_LOOPS_BY_CHANCE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_LOOPS_BY_CHANCE_H_

#include <utility>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// A map and its decisions, 1 for the edges in force and 0 for rejected loops.
struct DecidedMap {
  std::vector<Pose2> poses;
  std::vector<double> decisions;
};

// The part of its group that a loop belongs to: a group that follows a revisit over
// many poses is several.
using Part = std::pair<int, int>;
Part PartOf(const WhitenedEdge& loop, int group);

// How many wrong loops are to be expected in force with the noise of `solver`, if
// all that `map` rejects are wrong.
double WrongInForce(const DecidedMap& map, const LoopSupport& support,
                    RobustSolver* solver);

// Whether `wider`, with the larger noise of `solver`, takes in more groups of
// those that `map` rejects than would fit by chance if all of these were wrong,
// beside the right ones that a gate of 99 % rejects.
bool TakesInMoreThanByChance(const DecidedMap& map, const DecidedMap& wider,
                             const LoopSupport& support, RobustSolver* solver);

// What a narrower gate rejects of the loops in force in a map.
class NarrowedMap {
 public:
  // `solver` has the noise of `map`.
  NarrowedMap(const DecidedMap& map, const DecidedMap& narrower,
              const LoopSupport& support, RobustSolver* solver);

  // Whether it rejects more groups than can have come in by chance, if all that
  // `narrower` rejects are wrong, and these look as noisy as claimed: wrong ones are
  // anywhere within the gate.
  bool RejectsMoreThanByChance() const;
  // Whether some of those that it rejects may be wrong ones, which fit by chance.
  // Only these are a reason for a narrower gate.
  bool MayRejectWrongLoops() const;

 private:
  int in_force_ = 0;  // loops in the map
  int parts_ = 0;     // of groups of them, with rejected ones
  // Wrong loops to be expected in force; 0 where none is rejected.
  double wrong_in_force_ = 0.;
  // Logarithm of the odds that the rejected ones are as noisy as claimed.
  double log_odds_ = 0.;
};

// Right loops beyond the gate of a map: rejected loops that are within it if they
// are up to `claimed` times as noisy (standard deviations, more than one) as
// `edges` say, be it what their own matrices claim or what the largest of many
// samples may be. There are more groups of them than wrong ones would be by
// chance, and each has odds above one,
//
//   N(r; 0, S) / (1 / (2 pi A det W^-1)) (n - e) / (N - n + e),
//
// where n of N rejected groups are within the gate and e are expected there; S and
// W are those of the larger noise. Empty where these are not more than chance
// allows.
std::vector<int> FindHeavyTail(const DecidedMap& map, double claimed,
                               const LoopSupport& support,
                               const std::vector<WhitenedEdge>& edges);

// Whether of the loops that are in force by `decisions` no more are rejected by
// `others` than right ones by a gate of 99 %: then there is nothing to ask.
bool RejectsFew(const std::vector<WhitenedEdge>& edges,
                const std::vector<double>& decisions,
                const std::vector<double>& others);

// The least number of rare events that happens in less than one case in a
// thousand (Poisson).
double MoreThanExpected(double expected);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_NOISE_LOOPS_BY_CHANCE_H_
