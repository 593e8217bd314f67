// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds loops that agree with their neighbours. Two loops (a, b) and (c, d)
// whose ends are a few poses apart make a cycle a - b - d - c - a that closes
// when both are right. It contains only short pieces of odometry, so the test
// is accurate regardless of the uncertainty of the long path from a to b
// (pairwise consistency as in PCM, Mangelson et al. 2018, restricted to
// neighbours).
//
// Loops that agree, directly or over others, form a group: one revisit of a
// piece of the path. A group is one piece of evidence, whose strength grows
// with its size.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOOP_SUPPORT_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOOP_SUPPORT_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/kernels.h"

namespace cartographer_ext {
namespace optimization {

// Neighbourhood and gate of the test.
struct LoopSupportOptions {
  int window = 15;  // poses between the ends of neighbours
  double gate = kChi2Gate;
  int max_neighbours = 30;  // tested per loop
  // Poses from which the paths are kept; those from others are composed again.
  int max_paths = 10000;
};

// Agreement of loops and their groups.
struct LoopSupport {
  // Per edge: the loops that agree with it.
  std::vector<std::vector<int>> agreeing;
  // Per edge: the number of its group; -1 for odometry.
  std::vector<int> group;
  // Members of each group, ascending. Loops without support are groups of one.
  std::vector<std::vector<int>> groups;
  // chi2 of all cycles that were tested.
  std::vector<double> cycle_chi2;
};

// The error of the cycle that two neighbouring loops make, with the parts of its
// covariance that the claimed noise of loops and of odometry has.
struct LoopCycle {
  Eigen::Vector3d error;
  Eigen::Matrix3d of_loops;
  Eigen::Matrix3d of_odometry;
};

// The cycles of all pairs of neighbouring loops.
std::vector<LoopCycle> FindLoopCycles(const PoseGraph& graph,
                                      const LoopSupportOptions& options);

// Tests all pairs of neighbouring loops.
LoopSupport FindLoopSupport(const PoseGraph& graph,
                            const LoopSupportOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_LOOP_SUPPORT_H_
