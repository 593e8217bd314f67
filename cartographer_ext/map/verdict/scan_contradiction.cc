// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/scan_contradiction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cartographer_ext/map/verdict/placed_submaps.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// True where the ray goes through a wall and on, well before its end.
bool CrossesWall(const SubmapCells& cells, const Eigen::Vector2d& from,
                 const Eigen::Vector2d& to, const double margin) {
  const double length = (to - from).norm() - margin;
  const double step = cells.resolution();
  if (!(length > step)) return false;
  // In cells, of which each step is one long.
  const Eigen::Vector2d start = cells.Cell(from);
  const Eigen::Vector2d direction = (cells.Cell(to) - start).normalized();
  const double num_steps = length / step;
  bool in_wall = false;
  for (int64_t i = 1;; ++i) {
    const double travelled = static_cast<double>(i);
    if (!(travelled < num_steps)) return false;
    const CellView cell = cells.ViewOfCell(start + travelled * direction);
    if (cell.evidence == CellEvidence::kOccupied) in_wall = true;
    // Free space behind it: not just a graze along the wall.
    if (in_wall && cell.evidence == CellEvidence::kFree) return true;
    if (!in_wall) i += cell.clear_steps;
  }
}

ScanConflict HoldAgainst(const std::vector<Eigen::Vector2d>& scan,
                         const Pose2& local_from_node, const SubmapCells& cells,
                         const ContradictionOptions& options) {
  ScanConflict result;
  const Eigen::Vector2d origin = local_from_node.translation();
  for (const Eigen::Vector2d& point : scan) {
    const Eigen::Vector2d end = local_from_node * point;
    if (CrossesWall(cells, origin, end, options.ray_margin)) {
      ++result.judged;
      ++result.crossings;
      continue;
    }
    const CellView view = cells.View(end);
    if (view.near_occupied) {
      ++result.judged;
    } else if (view.evidence == CellEvidence::kFree) {
      ++result.judged;
      ++result.free_hits;
    }
  }
  return result;
}

// Judges one node against all submaps of other times; appends the conflicts.
NodeContradiction Judge(const std::vector<PlacedSubmap>& submaps,
                        const MapContents& contents, const GraphId& node_id,
                        const GraphNode& graph_node,
                        const ContradictionOptions& options,
                        std::vector<ScanConflict>* const conflicts) {
  NodeContradiction node;
  node.node_id = node_id;
  node.time = graph_node.time;
  const Pose2& pose = graph_node.global_pose;
  ForEachSubmapOfAnotherTime(
      submaps, contents, node_id, pose, options.min_node_gap,
      [&](const PlacedSubmap& submap) {
        ScanConflict conflict =
            HoldAgainst(contents.scans.at(node_id),
                        submap.LocalFromMap(pose.translation()) * pose,
                        *submap.cells, options);
        if (conflict.judged < options.min_judged) return;
        conflict.node_id = node_id;
        conflict.submap_id = submap.id;
        node.judged += conflict.judged;
        node.contradicted += conflict.free_hits + conflict.crossings;
        if (conflict.judged > node.widest_judged) {
          node.widest_judged = conflict.judged;
          node.widest_submap_id = submap.id;
        }
        if (conflict.fraction() > node.worst_fraction) {
          node.worst_fraction = conflict.fraction();
          node.worst_submap_id = submap.id;
        }
        if (conflict.fraction() > options.conflict_fraction) {
          conflicts->push_back(conflict);
        }
      });
  if (node.judged > 0) {
    node.fraction = static_cast<double>(node.contradicted) / node.judged;
    node.in_conflict = node.worst_fraction > options.conflict_fraction;
  }
  return node;
}

}  // namespace

Contradictions FindContradictions(const MapGraph& graph,
                                  const MapContents& contents,
                                  const ContradictionOptions& options) {
  const std::vector<PlacedSubmap> submaps = PlaceSubmaps(graph, contents);
  Contradictions result;
  std::vector<PieceNode> in_conflict;
  for (const auto& entry : graph.nodes) {
    const NodeContradiction node =
        Judge(submaps, contents, entry.first, entry.second, options,
              &result.conflicts);
    if (node.judged > 0) ++result.judged_nodes;
    result.judged_rays += node.judged;
    result.contradicted_rays += node.contradicted;
    if (node.in_conflict) {
      in_conflict.push_back(
          {node.node_id, node.worst_submap_id, node.worst_fraction, 0.});
    }
    result.nodes.push_back(node);
  }
  result.pieces = JoinToPieces(graph, in_conflict, options.pieces);
  for (const PathPiece& piece : result.pieces) {
    result.conflict_nodes += piece.num_nodes;
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
