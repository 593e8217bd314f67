// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/scan_contradiction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "cartographer_ext/map/verdict/placed_submaps.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// A ray through a submap, looked at in steps of one cell.
struct Ray {
  size_t point;
  Eigen::Vector2d direction;  // of length 1, cells
  double num_steps;
  // Steps after which it is a cell farther along the axis of its larger
  // advance, 1 to sqrt(2).
  double steps_per_cell;
  double step;  // the next, a whole number
  bool in_wall;
};

// Holds scans against submaps. All rays of a scan are taken one step farther in
// turn: a processor then works on many of them at a time, where along one ray
// each step must wait for what the submap says about the one before.
class ScanHolder {
 public:
  explicit ScanHolder(const ContradictionOptions& options)
      : options_(options) {}

  ScanConflict Hold(const std::vector<Eigen::Vector2d>& scan,
                    const Pose2& local_from_node, const SubmapCells& cells) {
    ScanConflict result;
    origin_ = local_from_node.translation();
    crossings_.clear();
    start_ = cells.Cell(origin_);
    start_reach_ = cells.ViewOfCell(start_).reach;
    LookAtEnds(scan, local_from_node, cells, &result);
    // Of the others none goes through a wall.
    if (result.judged + static_cast<int>(num_rays_) < options_.min_judged) {
      return result;
    }
    StartRays(scan, local_from_node, cells);
    while (num_rays_ > 0) AdvanceRays(cells, &result);
    return result;
  }

  // The same without the rays that contradict the submap within half of
  // `object_size` of one place: of all places that with the most of them.
  ScanConflict HoldWithoutObject(const std::vector<Eigen::Vector2d>& scan,
                                 const Pose2& local_from_node,
                                 const SubmapCells& cells) {
    ScanConflict result = Hold(scan, local_from_node, cells);
    std::vector<Eigen::Vector2d> places = crossings_;
    for (size_t i = 0; i != scan.size(); ++i) {
      if (ends_[i].is_free_hit) {
        places.push_back(cells.Cell(local_from_node * scan[i]));
      }
    }
    const double radius = 0.5 * options_.object_size / cells.resolution();
    const auto is_near = [&](const size_t i, const size_t k) {
      return (places[i] - places[k]).squaredNorm() <= radius * radius;
    };
    size_t center = 0;
    int most = 0;
    for (size_t i = 0; i != places.size(); ++i) {
      int near = 0;
      for (size_t k = 0; k != places.size(); ++k) near += is_near(i, k);
      if (near > most) {
        most = near;
        center = i;
      }
    }
    for (size_t i = 0; i != places.size(); ++i) {
      if (!is_near(center, i)) continue;
      --result.judged;
      --(i < crossings_.size() ? result.crossings : result.free_hits);
    }
    return result;
  }

 private:
  // Counts what the submap says about the ends, and collects the rays of which
  // that does not yet say whether they meet a wall.
  void LookAtEnds(const std::vector<Eigen::Vector2d>& scan,
                  const Pose2& local_from_node, const SubmapCells& cells,
                  ScanConflict* const result) {
    // Along the axis of the larger advance, cells.
    const double margin =
        options_.ray_margin / cells.resolution() * kLeastAdvance;
    if (rays_.size() < scan.size()) {
      ends_.resize(scan.size());
      rays_.resize(scan.size());
    }
    num_rays_ = 0;
    for (size_t i = 0; i != scan.size(); ++i) {
      const Eigen::Vector2d end = cells.Cell(local_from_node * scan[i]);
      const CellView view = cells.ViewOfCell(end);
      ends_[i].is_free_hit =
          view.evidence == CellEvidence::kFree && !view.near_occupied;
      ends_[i].is_judged = view.near_occupied || ends_[i].is_free_hit;
      result->judged += ends_[i].is_judged;
      result->free_hits += ends_[i].is_free_hit;
      const double length = (end - start_).cwiseAbs().maxCoeff();
      rays_[num_rays_].point = i;
      num_rays_ += !(start_reach_ >= length - std::max(margin, view.reach));
    }
  }

  void StartRays(const std::vector<Eigen::Vector2d>& scan,
                 const Pose2& local_from_node, const SubmapCells& cells) {
    const double step = cells.resolution();
    size_t kept = 0;
    for (size_t i = 0; i != num_rays_; ++i) {
      Ray ray = rays_[i];
      const Eigen::Vector2d end = local_from_node * scan[ray.point];
      const double length = (end - origin_).norm() - options_.ray_margin;
      ray.direction = (cells.Cell(end) - start_).normalized();
      ray.num_steps = length / step;
      ray.steps_per_cell = 1. / ray.direction.cwiseAbs().maxCoeff();
      ray.step =
          1. + std::floor(std::max(0., start_reach_) * ray.steps_per_cell);
      ray.in_wall = false;
      if (!(length > step) || !std::isfinite(ray.num_steps)) continue;
      if (ray.step < ray.num_steps) rays_[kept++] = ray;
    }
    num_rays_ = kept;
  }

  // Takes out rays at their ends, and those that go through a wall and on, well
  // before their ends: these count as such, and not for what is at their ends.
  void AdvanceRays(const SubmapCells& cells, ScanConflict* const result) {
    size_t kept = 0;
    for (size_t i = 0; i != num_rays_; ++i) {
      Ray ray = rays_[i];
      const CellView cell = cells.ViewOfCell(start_ + ray.step * ray.direction);
      ray.in_wall |= cell.evidence == CellEvidence::kOccupied;
      // Free space behind it: not just a graze along the wall.
      const bool crosses = ray.in_wall && cell.evidence == CellEvidence::kFree;
      if (crosses) {
        End& end = ends_[ray.point];
        result->judged += !end.is_judged;
        result->free_hits -= end.is_free_hit;
        end.is_free_hit = false;
        ++result->crossings;
        crossings_.push_back(start_ + ray.step * ray.direction);
      }
      // Nor is there free space outside.
      const int clear_steps =
          ray.in_wall && !cell.is_outside
              ? 0
              : static_cast<int>(cell.reach * ray.steps_per_cell);
      ray.step += 1 + clear_steps;
      rays_[kept] = ray;
      kept += !crosses && ray.step < ray.num_steps;
    }
    num_rays_ = kept;
  }

  // What a submap says about the end of a ray.
  struct End {
    bool is_judged;
    bool is_free_hit;
  };
  static constexpr double kLeastAdvance = 0.7071;  // a little under sqrt(0.5)

  const ContradictionOptions options_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();  // in the local frame
  Eigen::Vector2d start_ = Eigen::Vector2d::Zero();   // in cells
  double start_reach_ = 0.;
  std::vector<End> ends_;                   // by point; of what was held last
  std::vector<Eigen::Vector2d> crossings_;  // cells; of the same
  // Of which it is not known yet whether they go through a wall: the first
  // `num_rays_`. The memory is kept for the next scan.
  std::vector<Ray> rays_;
  size_t num_rays_ = 0;
};

double MeanRange(const std::vector<Eigen::Vector2d>& scan) {
  double sum = 0.;
  for (const Eigen::Vector2d& point : scan) sum += point.norm();
  return sum / static_cast<double>(std::max<size_t>(1, scan.size()));
}

// A scan held against a submap in whose local frame it was put there.
struct PlacedConflict {
  Pose2 local_from_node;
  ScanConflict conflict;
};

// The result that contradicts least of those that errors of the headings of the
// node and of the node that places the submap explain (scan_contradiction.h).
PlacedConflict HoldAsPlaced(const std::vector<Eigen::Vector2d>& scan,
                            const Pose2& pose, const PlacedSubmap& submap,
                            const ContradictionOptions& options,
                            ScanHolder* const holder) {
  const Anchor& anchor = submap.NearestAnchor(pose.translation());
  const auto hold_at = [&](const Pose2& map_from_node) {
    const Pose2 place = anchor.local_from_map * map_from_node;
    return PlacedConflict{place, holder->Hold(scan, place, *submap.cells)};
  };
  PlacedConflict least = hold_at(pose);
  const int min_judged =
      std::max(options.min_judged, least.conflict.judged / 2);
  const double lever =
      (pose.translation() - anchor.place).norm() + MeanRange(scan);
  const double reach =
      std::min(options.heading_sigmas * submap.heading_sigma * lever,
               options.max_displacement);
  if (least.conflict.judged < options.min_judged ||
      reach <= options.precision) {
    return least;
  }
  const Pose2 about(anchor.place.x(), anchor.place.y(), 0.);
  for (const double share : {0.5, -0.5, 1., -1.}) {
    const Pose2 turn(0., 0., share * reach / lever);
    for (const Pose2& turned :
         {about * turn * about.Inverse() * pose, pose * turn}) {
      if (least.conflict.fraction() <= options.conflict_fraction) return least;
      const PlacedConflict held = hold_at(turned);
      if (held.conflict.judged >= min_judged &&
          held.conflict.fraction() < least.conflict.fraction()) {
        least = held;
      }
    }
  }
  return least;
}

// Holds nodes against the submaps of other times.
class Judge {
 public:
  Judge(const MapGraph& graph, const MapContents& contents,
        const ContradictionOptions& options)
      : contents_(contents),
        options_(options),
        submaps_(PlaceSubmaps(graph, contents)),
        distinct_(DistinctNodes(graph, options.distinct)),
        path_(graph),
        holder_(options) {}

  // Appends the conflicts.
  NodeContradiction Look(const GraphId& node_id, const GraphNode& graph_node,
                         std::vector<ScanConflict>* const conflicts) {
    NodeContradiction node;
    node.node_id = node_id;
    node.time = graph_node.time;
    node.is_distinct = distinct_.count(node_id) > 0;
    const Pose2& pose = graph_node.global_pose;
    ForEachSubmapOfAnotherTime(
        submaps_, contents_, node_id, pose, options_.min_node_gap,
        [&](const PlacedSubmap& submap) {
          const std::vector<Eigen::Vector2d>& scan =
              contents_.scans.at(node_id);
          const PlacedConflict placed =
              HoldAsPlaced(scan, pose, submap, options_, &holder_);
          ScanConflict conflict = placed.conflict;
          if (conflict.judged < options_.min_judged) return;
          const bool is_one_visit = IsOneVisit(node_id, pose, submap);
          if (is_one_visit &&
              conflict.fraction() > options_.conflict_fraction) {
            conflict = holder_.HoldWithoutObject(scan, placed.local_from_node,
                                                 *submap.cells);
            if (conflict.judged < options_.min_judged) return;
          }
          conflict.node_id = node_id;
          conflict.submap_id = submap.id;
          conflict.is_one_visit = is_one_visit;
          conflict.is_distinct = node.is_distinct;
          Add(conflict, &node);
          if (conflict.fraction() > options_.conflict_fraction) {
            conflicts->push_back(conflict);
          }
        });
    if (node.judged > 0) {
      node.fraction = static_cast<double>(node.contradicted) / node.judged;
      node.in_conflict = node.worst_fraction > options_.conflict_fraction;
    }
    return node;
  }

 private:
  bool IsOneVisit(const GraphId& node_id, const Pose2& pose,
                  const PlacedSubmap& submap) const {
    const Anchor& anchor = submap.NearestAnchor(pose.translation());
    return path_.AreOneVisit(node_id, anchor.node_id,
                             (anchor.place - pose.translation()).norm(),
                             options_.visit_distance);
  }

  static void Add(const ScanConflict& conflict, NodeContradiction* const node) {
    node->is_revisit |= !conflict.is_one_visit;
    node->judged += conflict.judged;
    node->contradicted += conflict.free_hits + conflict.crossings;
    if (conflict.judged > node->widest_judged) {
      node->widest_judged = conflict.judged;
      node->widest_submap_id = conflict.submap_id;
    }
    if (conflict.fraction() > node->worst_fraction) {
      node->worst_fraction = conflict.fraction();
      node->worst_submap_id = conflict.submap_id;
    }
  }

  const MapContents& contents_;
  const ContradictionOptions options_;
  const std::vector<PlacedSubmap> submaps_;
  const std::set<GraphId> distinct_;
  const TravelledPath path_;
  ScanHolder holder_;
};

// Of conflicts by node, each node with the worst of its submaps.
std::vector<PathPiece> PiecesOf(const MapGraph& graph,
                                const std::vector<ScanConflict>& conflicts,
                                const bool one_visit,
                                const PathPieceOptions& options) {
  std::vector<PieceNode> nodes;
  for (const ScanConflict& conflict : conflicts) {
    if (conflict.is_one_visit != one_visit) continue;
    if (nodes.empty() || nodes.back().node_id != conflict.node_id) {
      nodes.push_back({conflict.node_id, {}, 0., 0., conflict.is_distinct});
    }
    if (conflict.fraction() > nodes.back().fraction) {
      nodes.back().submap_id = conflict.submap_id;
      nodes.back().fraction = conflict.fraction();
    }
  }
  return JoinToPieces(graph, nodes, options);
}

}  // namespace

ScanConflict HoldAgainst(const std::vector<Eigen::Vector2d>& scan,
                         const Pose2& local_from_node, const SubmapCells& cells,
                         const ContradictionOptions& options) {
  return ScanHolder(options).Hold(scan, local_from_node, cells);
}

Contradictions FindContradictions(const MapGraph& graph,
                                  const MapContents& contents,
                                  const ContradictionOptions& options) {
  Contradictions result;
  Judge judge(graph, contents, options);
  for (const auto& entry : graph.nodes) {
    const NodeContradiction node =
        judge.Look(entry.first, entry.second, &result.conflicts);
    result.distinct_nodes += node.is_distinct;
    result.judged_nodes += node.is_distinct && node.judged > 0;
    result.revisit_nodes += node.is_distinct && node.is_revisit;
    result.judged_rays += node.judged;
    result.contradicted_rays += node.contradicted;
    result.nodes.push_back(node);
  }
  result.pieces = PiecesOf(graph, result.conflicts, false, options.pieces);
  result.passing_pieces =
      PiecesOf(graph, result.conflicts, true, options.pieces);
  for (const PathPiece& piece : result.pieces) {
    result.conflict_nodes += piece.num_nodes;
  }
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
