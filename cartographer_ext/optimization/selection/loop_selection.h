// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Selects the loops of a growing map that are used in the next optimisation.
// Repeated before every optimisation, from the poses of the last one and with
// all loops, so that a rejected loop can be accepted again when the evidence
// changes.
//
//   1. Nothing changes if all loops except those rejected last time agree with
//      the poses and none of the rejected ones does. Everything else works on
//      the condensed graph (condensed_graph.h), which has a fraction of the
//      poses: least squares with all loops except the rejected ones. If the
//      result is consistent, the selection ends here; in this manner a true
//      loop after a long drift is accepted.
//   2. Otherwise DCS from the current poses and from those of (1), each
//      polished by the gate, which readmits loops that agree. The lowest
//      truncated cost wins. If it rejects more than a quarter of the loops,
//      and in thorough mode, the same from least squares with all loops and
//      from graduated non-convexity; if more than half of them are still
//      rejected, also from a replay of the graph (R-iSAM).
//   3. Odometry check with rollback (improved graph optimisation 2024, section
//      3.4): if the winner distorts the trajectory between neighbouring poses
//      beyond the gate (tested in the whole graph if the condensed one and
//      the steps within its pieces do not decide it), the suspect is the
//      loop with the largest chi2 among those that span the place. It is
//      disabled, the graph is solved again from the previous poses, and the result
//      is kept only if it has fewer such places.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_LOOP_SELECTION_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_LOOP_SELECTION_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/kernels.h"

namespace cartographer_ext {
namespace optimization {

// Gates and limits of the selection.
struct LoopSelectionOptions {
  bool robust_loops = true;
  double gate = kChi2Gate;  // of a loop, rejects one right loop in a hundred
  bool odometry_check = true;
  // chi2 (3 degrees of freedom) of the motion between neighbouring poses beyond
  // which a loop is suspect: above any noise of local SLAM.
  double odometry_gate = 30.;
  // Loops that the odometry check may disable in one selection, and so the
  // number of times it solves again.
  int max_rollbacks = 10;
  // Whether (2) may use the more expensive initial guesses.
  bool thorough = true;
  // Empty, or per edge whether the last selection rejected it.
  std::vector<bool> left_out_before;
};

// Result of the selection.
struct LoopSelection {
  std::vector<bool> accepted;  // per edge; true for all that are no loops
  std::vector<double> chi2;    // per loop; 0 for all others
  std::vector<int> suspects;   // edges disabled by the odometry check
  int violations = 0;          // remaining places beyond the odometry gate
};

// `neighbours` are the indices of the edges used by the odometry check, the
// motion between neighbouring poses: from a pose to a later one, at most one
// out of and one into a pose.
LoopSelection SelectLoops(const PoseGraph& graph,
                          const std::vector<int>& neighbours,
                          const LoopSelectionOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_LOOP_SELECTION_H_
