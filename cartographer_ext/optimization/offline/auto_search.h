// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// `auto`, the method that handles the failure cases of the single kernels:
//
//   1. a search by many solvers from many starts (portfolio.h) with the noise
//      that the information matrices claim;
//   2. where these turn out to claim too much (noise_metric.h: a gate that cuts
//      through the loops or has many just behind it, chi2 of the odometry
//      above its redundancy), the same search with the estimated noise, if the
//      loops then look as they should. That noise is the metric of all that
//      follows, the result included. Both factors are below one only where that
//      decides between two maps: where another map than that of the lowest cost is
//      likelier, each with the noise that it shows. The search then continues from
//      its members. So it does with the noise that loops show among themselves,
//      where that is less and explains a map better (cycle_noise.h), and with the
//      estimate where one of odometry and loops claims too much noise in relation to
//      the other; the larger of both factors then stays at least one. That is asked
//      last, as a wrong map shows a wrong ratio. Fewer than ten loops say nothing
//      about the noise by their residuals, but they may confirm each other far from
//      where odometry has led. In a small graph the evidence of maps with up to eight
//      times the noise decides besides (FindLikelierNoise): where a gate lets in a
//      part of the loops only, their residuals say nothing either;
//   3. the members near the lowest truncated cost polished with a gate adapted
//      to the scale of the accepted loops, where the matrices claim too much
//      noise, which in a sparse graph leave-one-out innovations alone show;
//      the lowest cost truncated there is taken. Where they do not, or where the
//      narrower gate rejects more than can be wrong (loops_by_chance.h), the
//      likeliest of the members of (4) (likeliest_map.h);
//   4. where that costs more than the best single solver, the lowest is taken,
//      brought near to (3) as far as it costs no more (polish_near.h). Where not
//      every solver has taken part, the limit is the lowest truncated cost, and
//      for large graphs half way from that to the solvers that have;
//   5. where hardly any loop is rejected and most of these lie just beyond the
//      gate, the gate is one that all right loops pass: the lowest cost truncated
//      there is taken, with these loops in force. Where many are rejected, right
//      ones among them are as noisy as the largest of so many, or, with a smaller
//      noise, as their matrices claim where most agree better: where these are
//      more than wrong ones that would fit by chance (loops_by_chance.h), the
//      gate is one that they pass, unless the lowest cost truncated there is that
//      of a map that loses others.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_AUTO_SEARCH_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_AUTO_SEARCH_H_

#include <string>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"
#include "cartographer_ext/optimization/offline/noise_scale.h"
#include "cartographer_ext/optimization/offline/portfolio.h"
#include "cartographer_ext/optimization/offline/rival_sets.h"
#include "cartographer_ext/optimization/solvers/robust_solver.h"

namespace cartographer_ext {
namespace optimization {

// Options of `auto`.
struct AutoOptions {
  PortfolioOptions portfolio;
  bool estimate_noise = true;
  bool adaptive_gate = true;
  bool lowest_cost = true;
};

// Result of `auto`.
struct AutoResult {
  std::vector<Pose2> poses;
  std::vector<double> weights;  // per edge
  std::vector<bool> accepted;   // per edge
  std::string member;
  double member_cost = 0.;
  double gate = kChi2Gate;  // of the truncated cost that is the lowest
  int iterations = 0;
  bool converged = false;
  // Factors of the standard deviations that the search has used; 1 unless the
  // information matrices claim too much, or of one kind too little.
  double applied_odometry_scale = 1.;
  double applied_loop_scale = 1.;
  // Estimate with regard to the given information matrices.
  NoiseScale noise;
  std::vector<RivalSets> rivals;
};

// Step 5 where hardly any loop is rejected, for the map of `result`. A gate of 99 %
// rejects one right loop in a hundred. One of `members` that leads to a lower cost is
// taken instead. False where no other gate is taken.
bool AcceptNearLoops(const std::vector<Portfolio::Member>& members,
                     RobustSolver* solver, AutoResult* result);

// Runs `auto` on a valid graph.
AutoResult SearchAutomatically(const PoseGraph& graph,
                               const AutoOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_OFFLINE_AUTO_SEARCH_H_
