// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/scan_contradiction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace cartographer_ext {
namespace evaluation {
namespace {

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

// A submap as seen from a node inserted in it. The optimisation moves the nodes
// of a submap against each other: where a long submap is bent, its far end as
// drawn lies elsewhere than the scans it was drawn from.
struct Anchor {
  Eigen::Vector2d place;  // of the node, map frame
  Pose2 local_from_map;   // of the submap, by the poses of this node
};

struct PlacedSubmap {
  GraphId id;
  const SubmapCells* cells;
  std::vector<Anchor> anchors;  // at least one
  int first_node, last_node;    // inserted
  Box box;                      // by the pose of the submap

  // As the inserted node nearest to a place saw it.
  const Pose2& LocalFromMap(const Eigen::Vector2d& place) const {
    const auto distance = [&place](const Anchor& anchor) {
      return (anchor.place - place).squaredNorm();
    };
    return std::min_element(anchors.begin(), anchors.end(),
                            [&distance](const Anchor& a, const Anchor& b) {
                              return distance(a) < distance(b);
                            })
        ->local_from_map;
  }
};

std::vector<PlacedSubmap> PlaceSubmaps(const MapGraph& graph,
                                       const MapContents& contents) {
  std::map<GraphId, std::vector<Anchor>> anchors;
  std::map<GraphId, std::pair<int, int>> spans;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop) continue;
    const auto submap = graph.submaps.find(constraint.submap_id);
    const auto node = graph.nodes.find(constraint.node_id);
    if (submap == graph.submaps.end() || node == graph.nodes.end()) continue;
    const Pose2& pose = node->second.global_pose;
    anchors[constraint.submap_id].push_back(
        {pose.translation(), submap->second.local_pose *
                                 constraint.relative_pose * pose.Inverse()});
    const int index = constraint.node_id.index;
    auto& span =
        spans.emplace(constraint.submap_id, std::make_pair(index, index))
            .first->second;
    span = {std::min(span.first, index), std::max(span.second, index)};
  }
  std::vector<PlacedSubmap> placed;
  for (const auto& entry : graph.submaps) {
    const auto cells = contents.submaps.find(entry.first);
    const auto span = spans.find(entry.first);
    if (cells == contents.submaps.end() || span == spans.end()) continue;
    placed.push_back({entry.first, &cells->second,
                      std::move(anchors.at(entry.first)), span->second.first,
                      span->second.second,
                      SubmapBox(cells->second, MapFromLocal(entry.second))});
  }
  return placed;
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
  const std::vector<PlacedSubmap> submaps = PlaceSubmaps(graph, contents);
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
      for (const PlacedSubmap& submap : submaps) {
        if (submap.id.trajectory_id == entry.first.trajectory_id &&
            entry.first.index > submap.first_node - options.min_node_gap &&
            entry.first.index < submap.last_node + options.min_node_gap) {
          continue;
        }
        if (!box.Meets(submap.box)) continue;
        ScanConflict conflict = HoldAgainst(
            scan->second, submap.LocalFromMap(pose.translation()) * pose,
            *submap.cells, options);
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
