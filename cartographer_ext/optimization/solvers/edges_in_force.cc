// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/solvers/edges_in_force.h"

#include "cartographer_ext/optimization/solvers/block_ldlt.h"

namespace cartographer_ext {
namespace optimization {

std::vector<std::pair<int, int>> PairsInForce(
    const std::vector<WhitenedEdge>& edges,
    const std::vector<double>& weights) {
  std::vector<std::pair<int, int>> pairs;
  for (size_t i = 0; i != edges.size(); ++i) {
    if (weights[i] > 0. && edges[i].from > 0 && edges[i].to > 0) {
      pairs.push_back({edges[i].from - 1, edges[i].to - 1});
    }
  }
  return pairs;
}

double FactorWork(const std::vector<WhitenedEdge>& edges,
                  const std::vector<double>& weights, const size_t num_poses) {
  if (num_poses < 2) return 0.;
  BlockLdlt factor;
  factor.Analyze(num_poses - 1, PairsInForce(edges, weights), {});
  return factor.work();
}

}  // namespace optimization
}  // namespace cartographer_ext
