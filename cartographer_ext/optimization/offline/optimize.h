// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Common interface to all back ends of this folder: from a graph and the name
// of a method to poses and a verdict on each loop.
//
// auto_search.h describes `auto`.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_OPTIMIZE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_OPTIMIZE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "cartographer_ext/optimization/offline/rival_sets.h"
#include "cartographer_ext/optimization/solvers/incremental_smoother.h"
#include "cartographer_ext/optimization/solvers/kernels.h"

namespace cartographer_ext {
namespace optimization {

// Method and its options.
struct OptimizeOptions {
  // none huber sc gm dcs acs acs_paper gnc_tls auto r_isam
  std::string method = "auto";
  // 0: the method's usual value (see DefaultKernel; sc: w = 1).
  double parameter = 0.;
  CovarianceNorm norm = CovarianceNorm::kSpectral;  // acs_paper
  int max_iterations = 200;
  double max_seconds = 1e9;  // sc, gnc_tls: processor time
  bool prune = true;
  // auto, r_isam: estimate the noise scale, and use it if the information
  // matrices are overconfident; r_isam then replays the graph once more.
  bool estimate_noise = true;
  // Other methods solve with the matrices as they are; this measures their
  // result (chi2, accepted) with the noise that `auto` would use, so that the
  // results of all methods can be compared. Takes the time of `auto`, which is
  // not counted.
  bool measure_with_estimated_noise = false;
  // auto: end with the gate narrowed to the scale of the accepted loops
  // (AdaptiveGate). Not for graphs whose information matrices are arbitrary,
  // such as Cartographer's, where it would reject right loops.
  bool adaptive_gate = true;
  // auto with adaptive_gate: no truncated cost above that of any single kernel,
  // and of such maps one near that of the adapted gate (polish_near.h).
  bool lowest_cost = true;
  SmootherOptions smoother;
  // Poses to start from instead of the graph's, all but auto and r_isam, which
  // choose their own. One per pose of the graph, with fixed poses as there;
  // empty: the graph's.
  std::vector<Pose2> start;
};

// Poses, verdicts and statistics.
struct OptimizeResult {
  std::vector<Pose2> poses;
  // Per edge: the weight with which it counts at the end, in [0, 1].
  std::vector<double> weights;
  // Per edge: chi2 at the end, and whether it is in force: chi2 < kChi2Gate,
  // for `auto` and `r_isam` the set that was solved with last. Always true for
  // odometry.
  std::vector<double> chi2;
  std::vector<bool> accepted;
  int iterations = 0;
  bool converged = false;
  double cpu_seconds = 0.;
  double odometry_chi2 = 0.;
  double accepted_loops_chi2 = 0.;
  double truncated_chi2 = 0.;  // TruncatedCost at the poses with the gate below
  // That of kChi2Gate with the information matrices as they were given.
  double truncated_chi2_as_given = 0.;
  // auto: the member chosen, and the lowest truncated cost of all before the
  // last polish.
  std::string member;
  double member_truncated_chi2 = 0.;
  std::vector<double> step_seconds;  // r_isam
  // auto: the scale of the noise with regard to the given information matrices,
  // and the scale that the result is measured with (all chi2 above).
  NoiseScale noise;
  double applied_odometry_scale = 1.;
  double applied_loop_scale = 1.;
  // kChi2Gate, or for `auto` one that all right loops pass, where hardly any is
  // beyond it.
  double applied_gate = kChi2Gate;
  // auto: sets of loops that explain the graph about as well; where one of them
  // moves the map, the graph is undecidable.
  std::vector<RivalSets> rivals;
};

// Names accepted as OptimizeOptions::method.
const std::vector<std::string>& MethodNames();

// Edges that hold the fixed poses of the graph relative to the first of them.
std::vector<PoseGraphEdge> FixedPoseEdges(const PoseGraph& graph);

// The fixed poses of the graph, or otherwise the first, do not move. An error
// for an invalid graph (ValidatePoseGraph), an unknown method or, with r_isam,
// a graph that cannot be replayed.
absl::StatusOr<OptimizeResult> Optimize(const PoseGraph& graph,
                                        const OptimizeOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_OPTIMIZE_H_
