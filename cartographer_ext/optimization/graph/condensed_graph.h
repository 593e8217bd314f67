// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A smaller pose graph with the same loops. Most poses of a trajectory are
// joined to others by trusted edges only; their information about the ends of
// the loops can be represented by one edge per piece of the chain of
// neighbouring poses:
//
//   z_ac = z_ab z_bc,  C_ac = Ad C_ab Ad^T + C_bc   (uncertain_pose.h)
//
// with C the covariance of the measurement z and Ad the adjoint of z_cb. A
// trusted edge to a removed pose is moved along the chain to the kept pose
// before it, and edges which then join the same two poses become one (their
// information adds up). This is exact for trusted edges that agree with each
// other, as the output of local SLAM does, and as long as the chain within a
// piece is stiff compared with the edges moved along it.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_CONDENSED_GRAPH_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_CONDENSED_GRAPH_H_

#include <vector>

#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// A condensed graph with its relation to the original.
struct CondensedGraph {
  PoseGraph graph;                  // poses in the order of the original
  std::vector<int> pose_of_vertex;  // original pose of each pose
  std::vector<int> loop_of_edge;    // original edge of a loop; -1 else
  std::vector<int> chain;           // edges along the chain, in order
  std::vector<int> chain_steps;     // original edges in each of these
};

// `neighbours` are the edges along the chain: from a pose to a later one, at
// most one out of and one into a pose. Kept are the first pose, ends of loops,
// poses that are not on the chain or at its ends, and as many more as needed so
// that no piece has more than `max_steps` edges.
CondensedGraph Condense(const PoseGraph& graph,
                        const std::vector<int>& neighbours, int max_steps);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_CONDENSED_GRAPH_H_
