// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests whether `auto` finds the lowest cost. On each graph it is compared with
// every other kernel from every initial guess, all by the same truncated cost,
// with the noise that `auto` applied.
#ifndef CARTOGRAPHER_EXT_EXPERIMENTS_COST_COMPARISON_H_
#define CARTOGRAPHER_EXT_EXPERIMENTS_COST_COMPARISON_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/experiments/sweep_graphs.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace experiments {

// Relative excess of the cost that counts as equal.
constexpr double kCostTolerance = 1e-6;

struct CostComparison {
  std::string dataset, type;
  std::string requested_count;  // as in SweepOptions::counts
  int count = 0;                // outliers
  int seed = 0;
  int poses = 0;
  int loops = 0;  // outliers included
  double cpu_seconds = 0.;
  double cost = 0.;  // truncated, of `auto`
  // The rival with the lowest cost: start, kernel and, where `auto` applied
  // another noise than the graph's, the noise it solved with.
  std::string rival;
  double rival_cost = 0.;
  double excess = 0.;  // (cost - rival_cost) / rival_cost
  // Where that is above kCostTolerance: ExcessWithNoise of what `auto` estimates.
  double estimated_excess = 0.;
  std::string member;  // OptimizeResult::member
};

// The excess of the cost of a map over that of another, each polished, with
// another noise than the information matrices claim. A map that costs more with
// the given noise may cost less with the actual one: where the matrices claim too
// much, the gate is wider than the right loops need, and bending odometry to
// wrong ones costs less than it should.
double ExcessWithNoise(const optimization::PoseGraph& graph,
                       const optimization::NoiseScale& noise,
                       const std::vector<Pose2>& poses,
                       const std::vector<Pose2>& rival);

// Kernels none, huber, gm, dcs, acs and gnc_tls from the poses of the graph, a
// spanning tree of short paths over all edges and a robust chordal relaxation;
// r_isam, which starts from nothing. With the information matrices as they are
// and as `auto` scales them. Of `options`, kernels and limits are not used;
// without outliers each graph is compared once, whatever the counts.
// Comparisons in the journal are not repeated; the journal of a sweep, or with
// other options, is an error.
absl::StatusOr<std::vector<CostComparison>> CompareCosts(
    const SweepOptions& options);

// By data set and type: graphs, those in which `auto` is above, and above with
// the estimated noise, too, largest excess; then each graph in which it is.
std::string CostTable(const std::vector<CostComparison>& comparisons);
nlohmann::ordered_json CostJson(const std::vector<CostComparison>& comparisons);

}  // namespace experiments
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_EXPERIMENTS_COST_COMPARISON_H_
