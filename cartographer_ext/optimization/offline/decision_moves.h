// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Moves in the space of decisions that lower the truncated cost after
// PolishTruncated has converged.
//
//   FlipLoops    one loop at a time. To bring in a rejected loop costs its
//                squared innovation r' (I + Q)^-1 r, Q = J H^-1 J', and saves
//                the gate; to let go of one in force costs the gate and saves
//                r' (I - Q)^-1 r. Both are exact on the linearised graph.
//   ForceGroups  one group of loops at a time is put in force whatever it
//                costs, all others judged by a robust kernel; then the group is
//                released and decided like the rest. This is how a wrong group
//                is replaced by several right ones that it keeps out. Where
//                that fails from the poses as they are, a chordal relaxation of
//                what is in force then is the start: a folded ring does not
//                unfold by descent.
//   RegrowGroups the map is grown on by the rejected loops that its uncertainty
//                allows (loop_growth.h), however far off they are. Then again
//                without one group in force and without what has no more loops
//                in force than it: the group stays out, the others may come
//                back. This is how wrong loops are replaced that agree with each
//                other and keep several right ones out, none of which alone
//                lowers the cost.
//
// A move is kept only if it lowers the truncated cost of the graph.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_DECISION_MOVES_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_DECISION_MOVES_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Whether two maps decide all loops alike but for those near the gate: whether no
// loop is in force in one and beyond four gates in the other, which is twice the
// residual that is accepted at most.
bool DifferNearGateOnly(const std::vector<WhitenedEdge>& edges,
                        const std::vector<Pose2>& a,
                        const std::vector<Pose2>& b);

// Limits of FlipLoops.
struct FlipOptions {
  double gate = kChi2Gate;
  int max_trials = 20;
  // Loops tested per round, those nearest to the gate first.
  int max_loops = 300;
};

// Returns the number of moves kept. `poses` must have converged.
int FlipLoops(const FlipOptions& options, RobustSolver* solver,
              std::vector<Pose2>* poses);

// RobustSolver::work() after which no other group is tried, some seconds: three
// times what all trials take on graphs of ordinary size. Where everything fits
// within the gate, the factor is full, and a trial may take a second.
constexpr double kMaxMoveWork = 1e10;

// Limits of ForceGroups.
struct ForceOptions {
  double gate = kChi2Gate;
  int max_trials = 30;
  int min_members = 1;  // of a group
  bool relax = true;    // try from a chordal relaxation, too
  double max_work = kMaxMoveWork;
  // Gates per rejected loop of the group by which the cost may rise while the
  // group is in force; a map that costs more is given up before the group is
  // released.
  double max_rise = 1e9;
};

// A solution that was found and not kept.
struct Alternative {
  double cost = 0.;  // truncated
  std::vector<Pose2> poses;
};

// `edges` are those of `solver`. Returns the number of moves kept. Solutions
// that cost at most one gate more than the best are added to `alternatives`,
// if not null.
int ForceGroups(const LoopSupport& support, const ForceOptions& options,
                std::vector<WhitenedEdge>* edges, RobustSolver* solver,
                std::vector<Pose2>* poses,
                std::vector<Alternative>* alternatives);

// Limits of RegrowGroups.
struct RegrowOptions {
  double gate = kChi2Gate;
  int max_trials = 40;
  int max_failures = 5;  // in succession
  double max_work = kMaxMoveWork;
};

// The same by growth. Odometry must reach all poses. Groups of each size in
// force take turns; one with more than half of all loops in force is kept.
int RegrowGroups(const LoopSupport& support, const RegrowOptions& options,
                 RobustSolver* solver, std::vector<Pose2>* poses,
                 std::vector<Alternative>* alternatives);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_DECISION_MOVES_H_
