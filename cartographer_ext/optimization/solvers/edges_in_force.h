// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How many loops of a pose graph are in force, and the sparsity of its linear systems
// in which some edges count. There the first pose is held: unknown k is pose k + 1.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_EDGES_IN_FORCE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_EDGES_IN_FORCE_H_

#include <algorithm>
#include <utility>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Loops of a graph, whitened or not.
template <typename Edge>
int CountLoops(const std::vector<Edge>& edges) {
  return std::count_if(edges.begin(), edges.end(),
                       [](const Edge& edge) { return edge.is_loop; });
}

// Those in force: with more than half of the weight. One weight, or decision, per
// edge.
template <typename Edge, typename Weight>
int CountLoopsInForce(const std::vector<Edge>& edges,
                      const std::vector<Weight>& weights) {
  int result = 0;
  for (size_t i = 0; i != edges.size(); ++i) {
    result += edges[i].is_loop && weights[i] > 0.5;
  }
  return result;
}

// Pairs of unknowns that share an edge of positive weight, one for each such
// edge between free poses, in the order of the edges. One weight per edge.
std::vector<std::pair<int, int>> PairsInForce(
    const std::vector<WhitenedEdge>& edges, const std::vector<double>& weights);

// Multiplications of one factorisation of the system of these edges, of
// `num_poses` poses.
double FactorWork(const std::vector<WhitenedEdge>& edges,
                  const std::vector<double>& weights, size_t num_poses);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_EDGES_IN_FORCE_H_
