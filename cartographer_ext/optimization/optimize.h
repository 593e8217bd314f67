// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One entrance to all back ends of this folder: a graph and the name of a
// method in, poses and a verdict on each loop out.
//
// `auto` guards against the local minima which every single kernel has:
//   1. an incremental replay of the graph (R-iSAM), which starts from nothing,
//      or, of several trajectories, a replay of each (joined_trajectories.h),
//      and DCS, GM and ACS from the graph's own poses;
//   2. unless the replay and DCS end at the same cost: DCS from the replay, a
//      second replay with a wider kernel, and with few loops GNC;
//   3. each result polished by deciding and solving in turn (re-admission);
//   4. those near the lowest truncated cost stay. Each true loop lost costs the
//      gate, so a folded map loses this comparison by a wide margin;
//   5. these are polished with the gate adapted to the scale of the accepted
//      loops, and the one with the lowest cost truncated there is taken;
//   6. where that costs more than half of what separates the lowest of (4) from
//      the best single kernel, the lowest is taken, brought near to (5).
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OPTIMIZE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OPTIMIZE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/optimization/incremental_smoother.h"
#include "cartographer_ext/optimization/kernels.h"
#include "cartographer_ext/optimization/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

struct OptimizeOptions {
  // none huber sc gm dcs acs acs_paper gnc_tls auto r_isam
  std::string method = "auto";
  // 0: the method's customary value (see DefaultKernel; sc: w = 1).
  double parameter = 0.;
  CovarianceNorm norm = CovarianceNorm::kSpectral;  // acs_paper
  int max_iterations = 200;
  double max_seconds = 1e9;  // sc, gnc_tls: processor time
  bool prune = true;
  // auto: end with the gate narrowed to the scale of the accepted loops
  // (AdaptiveGate). For graphs whose information matrices are only a guess,
  // such as those of Cartographer, it would cost right loops.
  bool adaptive_gate = true;
  // auto with adaptive_gate: no truncated cost above that of any single kernel,
  // and of such maps one near that of the adapted gate (polish_near.h).
  bool lowest_cost = true;
  SmootherOptions smoother;
};

struct OptimizeResult {
  std::vector<Pose2> poses;
  // Per edge: the weight with which it counts at the end, in [0, 1].
  std::vector<double> weights;
  // Per edge: chi2 at the end, and whether it is in force: chi2 < kChi2Gate,
  // for `auto` and `r_isam` the set of the last polish. Always true for
  // odometry.
  std::vector<double> chi2;
  std::vector<bool> accepted;
  int iterations = 0;
  bool converged = false;
  double cpu_seconds = 0.;
  double odometry_chi2 = 0.;
  double accepted_loops_chi2 = 0.;
  double truncated_chi2 = 0.;  // TruncatedCost at the poses
  // auto: the member chosen, and the lowest truncated cost of all before the
  // last polish.
  std::string member;
  double member_truncated_chi2 = 0.;
  std::vector<double> step_seconds;  // r_isam
};

// Names accepted as OptimizeOptions::method.
const std::vector<std::string>& MethodNames();

// The fixed poses of the graph, or else the first, end where they were. An
// error for an invalid graph (ValidatePoseGraph), an unknown method or, with
// r_isam, a graph that cannot be replayed.
absl::StatusOr<OptimizeResult> Optimize(const PoseGraph& graph,
                                        const OptimizeOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OPTIMIZE_H_
