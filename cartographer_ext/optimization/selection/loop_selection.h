// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which loops of a growing map may act in the next optimisation? Asked again
// before every optimisation, from the poses of the last one and with all loops,
// so that a loop judged wrong can come back when the evidence changes.
//
//   1. Nothing, where all loops but those left out last time agree with the
//      poses and none of those left out does. All that follows works on the
//      condensed graph (condensed_graph.h), which has a fraction of the poses:
//      least squares with all loops but those left out. When that settles it
//      nothing else happens; this is how a true loop after a long drift gets
//      in.
//   2. Otherwise DCS from the poses as they are and from those of (1), each
//      polished by the gate, which takes back in whatever agrees. The lowest
//      truncated cost wins. Where that leaves out more than a quarter of the
//      loops, and when asked to be thorough, the same from least squares with
//      all loops and from graduated non-convexity; where more than half of them
//      still stay out, also from a replay of the graph (R-iSAM).
//   3. Odometry check with rollback (improved graph optimisation 2024, section
//      3.4): where the winner bends the trajectory between neighbouring poses
//      beyond the gate (looked at in the whole graph where the condensed one
//      and the steps within its stretches leave that open), the loop to blame
//      is the one with the largest chi2 among those which span the place. It is
//      switched off, the graph is solved again from the poses before, and the
//      result is kept only if it has fewer such places.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_LOOP_SELECTION_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_LOOP_SELECTION_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/kernels.h"

namespace cartographer_ext {
namespace optimization {

struct LoopSelectionOptions {
  bool robust_loops = true;
  double gate = kChi2Gate;  // of a loop, rejects one right loop in a hundred
  bool odometry_check = true;
  // chi2 (3 degrees of freedom) of the motion between neighbouring poses beyond
  // which a loop is suspect: no noise of local SLAM goes so far.
  double odometry_gate = 30.;
  // Loops that the odometry check may disable in one selection, and so the
  // number of times it solves again.
  int max_rollbacks = 10;
  // Whether (2) may go on to the starts which cost more than the rest.
  bool thorough = true;
  // Empty, or per edge whether the last selection left it out.
  std::vector<bool> left_out_before;
};

struct LoopSelection {
  std::vector<bool> accepted;  // per edge; true for all that are no loops
  std::vector<double> chi2;    // per loop; 0 for all others
  std::vector<int> blamed;     // edges switched off by the odometry check
  int violations = 0;          // places beyond the odometry gate that remain
};

// `neighbours` are the indices of the edges which the odometry check looks at,
// the motion between neighbouring poses: from a pose to a later one, at most
// one out of and one into a pose.
LoopSelection SelectLoops(const PoseGraph& graph,
                          const std::vector<int>& neighbours,
                          const LoopSelectionOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_LOOP_SELECTION_H_
