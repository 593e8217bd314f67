// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Distortion of the steps within a path piece of a condensed graph. The poses
// in between are solved for with the vertices of the condensed graph fixed at
// its solution: a few small systems instead of the whole graph.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_STRETCH_BEND_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_STRETCH_BEND_H_

#include <vector>

#include "cartographer_ext/optimization/graph/condensed_graph.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Largest chi2 of any of `neighbours` within these pieces, indices into
// CondensedGraph::chain. `condensed` is the condensed `graph`, `poses` its
// solution. Infinite if an edge joins such a piece to a pose within another
// one, which these poses do not determine, or if a system is singular.
double LargestBend(const PoseGraph& graph, const std::vector<int>& neighbours,
                   const CondensedGraph& condensed,
                   const std::vector<Pose2>& poses,
                   const std::vector<int>& stretches);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_STRETCH_BEND_H_
