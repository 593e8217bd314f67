// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// An initial guess for graphs of several trajectories that are connected by
// loops only. Their relative poses are known only from these loops, some of
// which are wrong:
//   1. each trajectory is replayed by itself (IncrementalSmoother);
//   2. beginning with the first, the one with the most loops to those already
//      placed is put where one of these loops wants it, the one which the
//      others contradict least, by the sum of log(1 + chi2). That has no scale,
//      which the drift between two loops would exceed;
//   3. with the chosen loops in force whatever their error, the whole is solved
//      by kernels that narrow down to the gate.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_JOINED_TRAJECTORIES_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_JOINED_TRAJECTORIES_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/loop_support.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"

namespace cartographer_ext {
namespace optimization {

// Computes initial poses; the first is that of the graph. Returns false,
// without effect, if odometry connects all poses.
bool JoinTrajectories(const PoseGraph& graph, const SmootherOptions& options,
                      std::vector<Pose2>* poses);

// The same for graphs most of whose loops are wrong: where a trajectory has few
// loops of its own, what places it by itself is too uncertain, and kernels that are
// wide enough for its drift take in wrong loops. In step 2 a map of what is placed
// so far is grown (loop_growth.h) from each of the least contradicted places, and the
// one with the lowest truncated cost taken. False with more than ten trajectories, too.
bool GrowTrajectories(const PoseGraph& graph, const SmootherOptions& options,
                      const LoopSupport& support, std::vector<Pose2>* poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_STARTS_JOINED_TRAJECTORIES_H_
