// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The baseline of both papers: switchable constraints solved jointly for poses
// X and switches S (ACS eq. 5, R-iSAM eq. 13),
//
//   sum odometry + sum ||s_ij r_ij(X)||^2 + sum w (1 - s_ij)^2,  s_ij in [0,
//   1],
//
// with Ceres, one extra variable per loop. Also the same robust kernels as loss
// functions of Ceres, as an independent check of our own solver. Ceres'
// EvaluationCallback is not used: weights changed there make it compare costs
// of two different functions (it then stops after ten iterations without
// progress).
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_SWITCHABLE_CONSTRAINTS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_SWITCHABLE_CONSTRAINTS_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/solvers/kernels.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Penalty and limits.
struct SwitchableOptions {
  double penalty = 1.;  // w
  int max_iterations = 200;
  double function_tolerance = 1e-6;
  double max_seconds = 1e9;  // processor time
};

// One switch per edge is returned (1 for odometry). Switches start at 1, or at
// the values given when there are as many as edges. The summary's final cost is
// the value of the objective above.
SolverSummary SolveSwitchable(const std::vector<WhitenedEdge>& edges,
                              const SwitchableOptions& options,
                              std::vector<Pose2>* poses,
                              std::vector<double>* switches);

// Ceres with the kernel as loss function of the loops; kAcsPaper and kTruncated
// have none and are rejected by a CHECK.
SolverSummary SolveWithCeres(const std::vector<WhitenedEdge>& edges,
                             const KernelOptions& kernel, int max_iterations,
                             double function_tolerance,
                             std::vector<Pose2>* poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_SWITCHABLE_CONSTRAINTS_H_
