// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/scan_contradiction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

namespace cartographer_ext {
namespace evaluation {
namespace {

// The nodes inserted in a submap, as spans of indices by trajectory.
struct IndexSpan {
  int first = 0;
  int last = -1;
};

std::map<GraphId, IndexSpan> InsertionSpans(const MapGraph& graph) {
  std::map<GraphId, IndexSpan> spans;
  for (const auto& entry : graph.InsertedNodes()) {
    IndexSpan span;
    span.first = entry.second.front().index;
    span.last = entry.second.back().index;
    spans[entry.first] = span;
  }
  return spans;
}

// Axis-aligned box of a submap in the map frame.
struct Box {
  Eigen::Vector2d min, max;
  bool Meets(const Box& other) const {
    return (min.array() <= other.max.array()).all() &&
           (other.min.array() <= max.array()).all();
  }
};

Box SubmapBox(const SubmapCells& cells, const Pose2& map_from_local) {
  const Eigen::Vector2d low = cells.min_corner(), high = cells.max_corner();
  Box box{map_from_local * low, map_from_local * low};
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(low.x(), high.y()), Eigen::Vector2d(high.x(), low.y()),
        high}) {
    const Eigen::Vector2d point = map_from_local * corner;
    box.min = box.min.cwiseMin(point);
    box.max = box.max.cwiseMax(point);
  }
  return box;
}

// True where the ray goes through a wall and on, well before its end.
bool CrossesWall(const SubmapCells& cells, const Eigen::Vector2d& from,
                 const Eigen::Vector2d& to, const double margin) {
  const double length = (to - from).norm() - margin;
  const double step = cells.resolution();
  if (!(length > step)) return false;
  const Eigen::Vector2d direction = (to - from).normalized();
  bool in_wall = false;
  for (int64_t i = 1;; ++i) {
    const double travelled = static_cast<double>(i) * step;
    if (!(travelled < length)) return false;
    const CellView cell = cells.View(from + travelled * direction);
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
    } else if (cells.NearOccupied(end)) {
      ++result.judged;
    } else if (cells.At(end) == CellEvidence::kFree) {
      ++result.judged;
      ++result.free_hits;
    }
  }
  return result;
}

// Joins the nodes in conflict to pieces.
void FindPieces(const MapGraph& graph, const ContradictionOptions& options,
                Contradictions* const result) {
  std::vector<const NodeContradiction*> open;
  const auto close = [&]() {
    if (static_cast<int>(open.size()) >= options.min_piece_nodes) {
      ConflictPiece piece;
      piece.first_node = open.front()->node_id;
      piece.last_node = open.back()->node_id;
      piece.begin = open.front()->time;
      piece.end = open.back()->time;
      piece.num_nodes = static_cast<int>(open.size());
      std::set<GraphId> submaps;
      Eigen::Vector2d last = Eigen::Vector2d::Zero();
      for (size_t i = 0; i < open.size(); ++i) {
        const Eigen::Vector2d place =
            graph.nodes.at(open[i]->node_id).global_pose.translation();
        piece.center += place / static_cast<double>(open.size());
        if (i > 0) piece.metres += (place - last).norm();
        last = place;
        submaps.insert(open[i]->worst_submap_id);
        piece.fraction +=
            open[i]->worst_fraction / static_cast<double>(open.size());
      }
      piece.submaps.assign(submaps.begin(), submaps.end());
      result->conflict_nodes += piece.num_nodes;
      result->pieces.push_back(piece);
    }
    open.clear();
  };
  for (const NodeContradiction& node : result->nodes) {
    if (!node.in_conflict) continue;
    if (!open.empty() &&
        (open.back()->node_id.trajectory_id != node.node_id.trajectory_id ||
         node.node_id.index - open.back()->node_id.index >
             options.piece_break)) {
      close();
    }
    open.push_back(&node);
  }
  close();
}

}  // namespace

Contradictions FindContradictions(const MapGraph& graph,
                                  const MapContents& contents,
                                  const ContradictionOptions& options) {
  struct Placed {
    GraphId id;
    const SubmapCells* cells;
    Pose2 local_from_map;
    Box box;
    IndexSpan span;
  };
  const auto spans = InsertionSpans(graph);
  std::vector<Placed> submaps;
  for (const auto& entry : graph.submaps) {
    const auto cells = contents.submaps.find(entry.first);
    const auto span = spans.find(entry.first);
    if (cells == contents.submaps.end() || span == spans.end()) continue;
    const Pose2 map_from_local = MapFromLocal(entry.second);
    submaps.push_back({entry.first, &cells->second, map_from_local.Inverse(),
                       SubmapBox(cells->second, map_from_local), span->second});
  }
  Contradictions result;
  for (const auto& entry : graph.nodes) {
    NodeContradiction node;
    node.node_id = entry.first;
    node.time = entry.second.time;
    const auto scan = contents.scans.find(entry.first);
    if (scan != contents.scans.end() && !scan->second.empty()) {
      const Pose2& pose = entry.second.global_pose;
      Box box{pose.translation(), pose.translation()};
      for (const Eigen::Vector2d& point : scan->second) {
        const Eigen::Vector2d end = pose * point;
        box.min = box.min.cwiseMin(end);
        box.max = box.max.cwiseMax(end);
      }
      for (const Placed& submap : submaps) {
        if (submap.id.trajectory_id == entry.first.trajectory_id &&
            entry.first.index > submap.span.first - options.min_node_gap &&
            entry.first.index < submap.span.last + options.min_node_gap) {
          continue;
        }
        if (!box.Meets(submap.box)) continue;
        ScanConflict conflict = HoldAgainst(
            scan->second, submap.local_from_map * pose, *submap.cells, options);
        if (conflict.judged < options.min_judged) continue;
        conflict.node_id = entry.first;
        conflict.submap_id = submap.id;
        node.judged += conflict.judged;
        node.contradicted += conflict.free_hits + conflict.crossings;
        if (conflict.fraction() > node.worst_fraction) {
          node.worst_fraction = conflict.fraction();
          node.worst_submap_id = submap.id;
        }
        if (conflict.fraction() > options.conflict_fraction) {
          result.conflicts.push_back(conflict);
        }
      }
    }
    if (node.judged > 0) {
      ++result.judged_nodes;
      node.fraction = static_cast<double>(node.contradicted) / node.judged;
      node.in_conflict = node.worst_fraction > options.conflict_fraction;
    }
    result.judged_rays += node.judged;
    result.contradicted_rays += node.contradicted;
    result.nodes.push_back(node);
  }
  FindPieces(graph, options, &result);
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
