// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Consecutive nodes that disagree with what was mapped at another time.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_PATH_PIECE_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_PATH_PIECE_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// A node that disagrees with a submap of another time.
struct PieceNode {
  GraphId node_id;
  GraphId submap_id;
  double fraction = 0.;      // of its rays that contradict the submap
  double displacement = 0.;  // from where it fits the submap, metres
};

struct PathPiece {
  GraphId first_node, last_node;
  io::TimeNs begin = 0, end = 0;
  int num_nodes = 0;               // that disagree
  Eigen::Vector2d center{0., 0.};  // mean position of the nodes, map frame
  double metres = 0.;              // of path
  std::vector<GraphId> submaps;    // by id
  // Means over the nodes.
  double fraction = 0.;
  double displacement = 0.;
  // Or else contradicted.
  bool is_displaced() const { return displacement > 0.; }
  // The larger the worse, among pieces of the same kind.
  double severity() const {
    return num_nodes * (is_displaced() ? displacement : fraction);
  }
};

struct PathPieceOptions {
  // Pieces of fewer nodes are left out.
  int min_nodes = 3;
  // Indices without such a node that do not end a piece.
  int max_gap = 5;
};

// `nodes` of the graph, by id.
std::vector<PathPiece> JoinToPieces(const MapGraph& graph,
                                    const std::vector<PieceNode>& nodes,
                                    const PathPieceOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_PATH_PIECE_H_
