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
//                after a change, the first that helps:
//                - a rejected loop is put in force that the map nearly allows.
//                  Several right ones that have to come in together follow it,
//                  each of which alone would cost more than the gate. Of these
//                  trials the best is kept;
//                - the loops in force are solved with other windings (windings.h),
//                  of which the best is kept;
//                - one group in force is released alone, those first whose
//                  release saves more chi2 than that of right loops would; if
//                  nothing better follows, rejected loops are put in force then;
//                - one group in force is released, and what has no more loops
//                  in force than it; the group stays out, the others may come
//                  back.
//                This is how wrong loops are replaced that agree with each other
//                and keep several right ones out, none of which alone lowers the
//                cost. After a change the map is solved from a chordal
//                relaxation, too, which unfolds what wrong loops have folded.
//
// A move is kept only if it lowers the truncated cost of the graph.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_DECISION_MOVES_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_DECISION_MOVES_H_

#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/offline/parts/lost_part.h"
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
  // Only those of its loops count that lead out of this part of the path.
  absl::optional<PartOfPath> part;
  bool relax = true;  // try from a chordal relaxation, too
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
  // Whether there is much more evidence for it than for the one that was kept.
  bool is_likelier = false;
};

// The map of lowest truncated cost so far.
class LowestCost {
 public:
  // A map is taken over if its cost is lower by the share `progress`. What is
  // offered or replaced is an alternative if it costs less than a gate more.
  // `edges` and `poses` must outlive this; `alternatives` may be null.
  LowestCost(const std::vector<WhitenedEdge>& edges, double gate,
             double progress, std::vector<Pose2>* poses,
             std::vector<Alternative>* alternatives);

  // Whether the map was taken over.
  bool Offer(std::vector<Pose2> moved);

  double cost() const { return cost_; }

 private:
  const std::vector<WhitenedEdge>& edges_;
  const double gate_;
  const double progress_;
  std::vector<Pose2>& poses_;
  std::vector<Alternative>* const alternatives_;
  double cost_;
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
  int max_trials = 80;
  // In succession, of groups that are released with others.
  int max_failures = 5;
  // The same of loops that are put in force and of groups that are released
  // alone; and of loops that are put in force after each of these.
  int max_near = 5;
  int max_forced = 2;
  // The same of groups that maps are grown from anew: each takes a whole growth.
  int max_starts = 0;
  // Other windings of the loops in force that maps are grown from, those first with
  // which these cost least.
  int max_windings = 4;
  // Nothing but these and growth, and that only where there are any.
  bool windings_alone = false;
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
