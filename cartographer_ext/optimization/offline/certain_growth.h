// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Growth (loop_growth.h) for large graphs: many loops a round instead of one
// group, and only what can have changed is worked out again.
//
// A loop is certain when the likelihood of its innovation r with covariance S,
// compared with that of a loop which may lead anywhere in the map, outweighs
// the number n of open loops:
//
//   log N(r; 0, S) - log 1 / (2 pi A det W^-1)  >  log n + log k,
//
// so that of all that are taken in at once 1 / k is expected to be wrong; k
// falls from 100 to 1 where no more come in. First these are loops over short
// stretches of odometry; with them in force the next ones are sharply predicted.
// Of loops that fit the poses as they are, whatever S, 1 / k is expected to be
// wrong when they are k times as many as would fit by chance: these come in, too.
//
// Before the first round S follows from sums along the chain of odometry: with
// Ad_k the adjoint of pose k and C_k the covariance of the step to it,
//
//   W_k = sum_(i <= k) Ad_i C_i Ad_i'
//
// W_b - W_a is the covariance of (a <- b) as a twist of the map. Later S comes
// from the factor, for the open loops that do not contradict their last S. As a
// prediction costs as much as a thousandth of a factorisation, only some are
// made in one round, first where loops have come in: these are the ones that
// they make sharper.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_CERTAIN_GROWTH_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_CERTAIN_GROWTH_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/solvers/kernels.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Limits of the growth.
struct CertainGrowthOptions {
  double gate = kChi2Gate;  // of the innovation
  // Ends earlier if no more loops are accepted.
  int max_rounds = 100;
  // What the predictions by the factor may take in one round, in factorisations,
  // and at least in multiplications.
  double prediction_work = 2.;
  double min_prediction_work = 3e8;
  // chi2 of a loop's last prediction, which further loops only make sharper, in
  // gates, up to which it is predicted anew; poses may have moved since.
  double max_gates = 10.;
};

// Covariance S = I + J C J' of the whitened innovation of each loop with regard
// to odometry alone, identity for other edges; `poses` are chained odometry.
// Empty unless odometry leads from each pose to the next.
std::vector<Eigen::Matrix3d> PredictAlongChain(
    const PoseGraph& graph, const std::vector<WhitenedEdge>& edges,
    const std::vector<Pose2>& poses);

// Replaces `poses`, chained odometry, by a solution with the certain loops,
// given by `weights`, one per edge. `solver` is that of the graph's edges.
// Returns the number of loops in force, 0 if odometry is not a chain.
int GrowCertainLoops(const PoseGraph& graph,
                     const CertainGrowthOptions& options, RobustSolver* solver,
                     std::vector<Pose2>* poses, std::vector<double>* weights);
// The same from a map that is nearer to the right one, with the loops that have
// weight in force; they may be given up.
int GrowMoreCertainLoops(const PoseGraph& graph,
                         const CertainGrowthOptions& options,
                         RobustSolver* solver, std::vector<Pose2>* poses,
                         std::vector<double>* weights);

// Replaces `poses`, chained odometry, by a solution with the certain loops and groups
// of others (loop_growth.h) in turn, until neither brings any in: where headings are
// lost after some steps, few loops are certain, but with a few groups in force others
// are, and the fewer groups come in one by one, the fewer wrong ones do. False if no
// loop is certain or odometry is not a chain.
bool GrowCertainLoopsAndGroups(const PoseGraph& graph,
                               const LoopSupport& support, RobustSolver* solver,
                               std::vector<Pose2>* poses,
                               std::vector<double>* weights);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_CERTAIN_GROWTH_H_
