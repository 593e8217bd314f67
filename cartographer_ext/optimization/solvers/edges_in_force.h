// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The sparsity of the linear systems of a pose graph in which some edges count.
// The first pose is held: unknown k is pose k + 1.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_EDGES_IN_FORCE_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SOLVERS_EDGES_IN_FORCE_H_

#include <utility>
#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

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
