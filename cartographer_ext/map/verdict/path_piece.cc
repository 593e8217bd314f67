// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/path_piece.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cartographer_ext {
namespace evaluation {
namespace {

int NumDistinct(const std::vector<PieceNode>& nodes) {
  return static_cast<int>(
      std::count_if(nodes.begin(), nodes.end(),
                    [](const PieceNode& node) { return node.is_distinct; }));
}

PathPiece Summarize(const MapGraph& graph,
                    const std::vector<PieceNode>& nodes) {
  PathPiece piece;
  piece.first_node = nodes.front().node_id;
  piece.last_node = nodes.back().node_id;
  piece.begin = graph.nodes.at(piece.first_node).time;
  piece.end = graph.nodes.at(piece.last_node).time;
  piece.num_nodes = NumDistinct(nodes);
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

std::set<GraphId> DistinctNodes(const MapGraph& graph,
                                const DistinctNodeOptions& options) {
  std::set<GraphId> distinct;
  Pose2 last;
  for (const auto& node : graph.nodes) {
    const Pose2& pose = node.second.global_pose;
    const bool is_first =
        distinct.empty() ||
        distinct.rbegin()->trajectory_id != node.first.trajectory_id;
    const Pose2 step = last.Inverse() * pose;
    if (!is_first && step.translation().norm() < options.distance &&
        std::abs(step.theta) < options.turn) {
      continue;
    }
    distinct.insert(node.first);
    last = pose;
  }
  return distinct;
}

std::vector<PathPiece> JoinToPieces(const MapGraph& graph,
                                    const std::vector<PieceNode>& nodes,
                                    const PathPieceOptions& options) {
  std::vector<PathPiece> pieces;
  std::vector<PieceNode> open;
  const auto close = [&]() {
    if (!open.empty() && NumDistinct(open) >= options.min_nodes) {
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
