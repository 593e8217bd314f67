// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// An initial guess that is grown from odometry by one group of loops after the
// other, the most certain first. For graphs whose odometry is uncertain over
// long paths: a right loop then has a huge chi2 and no solver that starts from
// odometry accepts it. Its innovation r, with the covariance of the prediction
//
//   S = I + J H^-1 J',   d2 = r' S^-1 r,
//
// separates right from wrong loops as far as the data allow. The order is that
// of the logarithm of the likelihood ratio between a right loop and one that
// may lead anywhere in the map (area A, any direction),
//
//   log N(r; 0, S) - log 1 / (2 pi A det W^-1),
//
// to which each loop of the same group (loop_support.h) adds its own. After
// each group the poses are solved again, if necessary from a chordal
// relaxation, and all innovations are recomputed: loops with an uncertain
// prediction before are then predicted accurately.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOOP_GROWTH_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOOP_GROWTH_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/solvers/loop_evidence.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Gate and limits of the growth.
struct GrowthOptions {
  double gate = kChi2Gate;  // of d2
  int max_rounds = 80;
  // Loops tested per round; more are subsampled evenly.
  int max_candidates = 1500;
  // Loops that a group of more members counts for.
  int max_support = 8;
};

// Poses times loops beyond which the search by groups is too expensive.
constexpr double kMaxGrowthWork = 4e6;

// Innovations of `loops` with regard to the poses and the edges in force
// (weight 1; loops with weight 0 are not). Empty when the edges in force do not
// determine the poses.
std::vector<Innovation> PredictLoops(const std::vector<int>& loops,
                                     const std::vector<double>& weights,
                                     const std::vector<Pose2>& poses,
                                     RobustSolver* solver);

// Whether more rejected loops are within the gate than expected of wrong ones
// by chance: then the map may lack right ones.
bool MorePossibleThanByChance(const std::vector<Innovation>& innovations);

// Replaces `poses` by a solution with the accepted loops, given by `weights`,
// one per edge. `solver` is that of `edges`. Odometry must reach all poses.
bool GrowLoops(const LoopSupport& support, const GrowthOptions& options,
               RobustSolver* solver, std::vector<Pose2>* poses,
               std::vector<double>* weights);

// The same from a map: `poses` with the loops in force that have weight 1.
// Those that are `banned`, one flag per edge, stay out. The loops that come in
// may contradict some in force, which are not released.
bool ContinueGrowth(const LoopSupport& support, const GrowthOptions& options,
                    const std::vector<bool>& banned, RobustSolver* solver,
                    std::vector<Pose2>* poses, std::vector<double>* weights);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOOP_GROWTH_H_
