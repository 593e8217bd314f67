// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/path_piece.h"

#include <cstddef>
#include <set>

namespace cartographer_ext {
namespace evaluation {
namespace {

PathPiece Summarize(const MapGraph& graph,
                    const std::vector<PieceNode>& nodes) {
  PathPiece piece;
  piece.first_node = nodes.front().node_id;
  piece.last_node = nodes.back().node_id;
  piece.begin = graph.nodes.at(piece.first_node).time;
  piece.end = graph.nodes.at(piece.last_node).time;
  piece.num_nodes = static_cast<int>(nodes.size());
  std::set<GraphId> submaps;
  const auto count = static_cast<double>(nodes.size());
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Vector2d place =
        graph.nodes.at(nodes[i].node_id).global_pose.translation();
    piece.center += place / count;
    if (i > 0) piece.metres += (place - last).norm();
    last = place;
    submaps.insert(nodes[i].submap_id);
    piece.fraction += nodes[i].fraction / count;
    piece.displacement += nodes[i].displacement / count;
  }
  piece.submaps.assign(submaps.begin(), submaps.end());
  return piece;
}

}  // namespace

std::vector<PathPiece> JoinToPieces(const MapGraph& graph,
                                    const std::vector<PieceNode>& nodes,
                                    const PathPieceOptions& options) {
  std::vector<PathPiece> pieces;
  std::vector<PieceNode> open;
  const auto close = [&]() {
    if (!open.empty() && static_cast<int>(open.size()) >= options.min_nodes) {
      pieces.push_back(Summarize(graph, open));
    }
    open.clear();
  };
  for (const PieceNode& node : nodes) {
    if (!open.empty() &&
        (open.back().node_id.trajectory_id != node.node_id.trajectory_id ||
         node.node_id.index - open.back().node_id.index > options.max_gap)) {
      close();
    }
    open.push_back(node);
  }
  close();
  return pieces;
}

}  // namespace evaluation
}  // namespace cartographer_ext
