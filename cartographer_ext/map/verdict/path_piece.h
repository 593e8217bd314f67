// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Consecutive nodes that disagree with what was mapped at another time, and
// which of them count.
//
// A robot that stands sees the same again and again, and a fast laser on a slow
// robot nearly so: such nodes are no further evidence, neither for a map nor
// against it. Cartographer inserts a node every few seconds where the robot
// stands, and every scan if its motion filter is off.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_PATH_PIECE_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_PATH_PIECE_H_

#include <set>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// What a node must at least have moved since the last distinct one.
struct DistinctNodeOptions {
  double distance = 0.05;      // metres
  double turn = DegToRad(1.);  // radians
};

// The first node of each trajectory, and those that have moved since, by the
// poses in the map.
std::set<GraphId> DistinctNodes(const MapGraph& graph,
                                const DistinctNodeOptions& options);

// A node that disagrees with a submap of another time.
struct PieceNode {
  GraphId node_id;
  GraphId submap_id;
  double fraction = 0.;      // of its rays that contradict the submap
  double displacement = 0.;  // from where it fits the submap, metres
  bool is_distinct = true;   // DistinctNodes: it counts
};

struct PathPiece {
  GraphId first_node, last_node;
  io::TimeNs begin = 0, end = 0;
  int num_nodes = 0;               // distinct ones that disagree
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
  // Pieces of fewer distinct nodes are left out.
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
