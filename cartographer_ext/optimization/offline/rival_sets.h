// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Ambiguous decisions: another set of loops that explains the graph about as
// well as the one in force, but is incompatible with it. The truncated costs
// then differ by less than the gate, and no estimator can determine from the
// graph alone which set is right. That matters where the other set leads to
// another map; a few loops near the gate often leave the map where it is. The same
// set of loops leads to another map where it is wound otherwise (windings.h). A map that
// costs more is a rival, too, if there is much more evidence for it (likeliest_map.h).
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_RIVAL_SETS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_RIVAL_SETS_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/decision_moves.h"
#include "cartographer_ext/optimization/solvers/kernels.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Edges are given by their index.
struct RivalSets {
  std::vector<int> only_in_force;  // loops in force that the rival rejects
  std::vector<int> only_in_rival;
  // Whether there is much more evidence for the rival, whatever it costs.
  bool is_likelier = false;
  double cost_difference = 0.;  // truncated cost of the rival minus ours
  double largest_shift = 0.;    // metres, between the poses of the two maps
  // The same in standard deviations that the loops in force leave a position
  // relative to the first pose, of up to 50 poses.
  double deviation = 0.;
  // Whether the two are different maps, see RivalOptions.
  bool moves_map = true;
};

// When two sets of loops count as different.
struct RivalOptions {
  double gate = kChi2Gate;
  // Sets that differ by fewer loops, on either side, and have the same winding are
  // considered one set with loops near the gate. If fewer than ten times as many are in force, one
  // less is enough.
  int min_loops = 2;
  size_t max_rivals = 5;
  // A rival that moves no pose by more than this (metres), or none beyond the
  // 99 % that its own standard deviations allow (the root of the quantile of
  // chi2 with two degrees of freedom), leaves the map what it is.
  double same_place = 0.005;
  double same_deviation = 3.034854258770293;
};

// Rivals of the map `poses` with the edges of `solver`: those that move the map
// first, of them a likelier one, then the closest first; of several with the same loops only one.
std::vector<RivalSets> FindRivalSets(
    const std::vector<Pose2>& poses,
    const std::vector<Alternative>& alternatives, const RivalOptions& options,
    RobustSolver* solver);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_RIVAL_SETS_H_
