// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/loops_by_hand.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/mapping/value_conversion_tables.h"
#include "cartographer_ext/io/pbstream/grid_validation.h"
#include "cartographer_ext/loop_closure/dropin/node_geometry.h"
#include "cartographer_ext/loop_closure/dropin/submap_matcher.h"
#include "cartographer_ext/loop_closure/loop_options.h"
#include "cartographer_ext/loop_closure/verification/temporal_verification.h"

namespace cartographer_ext {
namespace repair {
namespace {

using cartographer::mapping::Submap2D;
using cartographer::mapping::TrajectoryNode;
using evaluation::GraphId;
using loop_closure::OccupancyView;
using loop_closure::SubmapMatch;

constexpr double kMaxCoordinate = 1e6;  // metres

absl::StatusOr<LoopByHand> Parse(const std::string& name) {
  const std::vector<std::string> parts = absl::StrSplit(name, ':');
  LoopByHand loop;
  int ids[4] = {0, 0, 0, 0};
  double pose[3] = {0., 0., 0.};
  bool ok = parts.size() == 4 || parts.size() == 7;
  for (size_t i = 0; ok && i < parts.size(); ++i) {
    ok = i < 4 ? absl::SimpleAtoi(parts[i], &ids[i])
               : absl::SimpleAtod(parts[i], &pose[i - 4]) &&
                     std::abs(pose[i - 4]) <= kMaxCoordinate;
  }
  if (!ok) {
    return absl::InvalidArgumentError(
        absl::StrCat("'", name,
                     "' is not submap_trajectory:submap:node_trajectory:node "
                     "or that with :x:y:theta"));
  }
  loop.submap_id = {ids[0], ids[1]};
  loop.node_id = {ids[2], ids[3]};
  if (parts.size() == 7) loop.pose = Pose2(pose[0], pose[1], pose[2]);
  return loop;
}

absl::Status CheckIsNew(const LoopByHand& loop,
                        const evaluation::MapGraph& graph) {
  if (graph.submaps.count(loop.submap_id) == 0) {
    return absl::NotFoundError(absl::StrCat(
        "the map has no submap ", evaluation::ToString(loop.submap_id)));
  }
  if (graph.nodes.count(loop.node_id) == 0) {
    return absl::NotFoundError(absl::StrCat(
        "the map has no node ", evaluation::ToString(loop.node_id)));
  }
  for (const auto& constraint : graph.constraints) {
    if (constraint.submap_id == loop.submap_id &&
        constraint.node_id == loop.node_id) {
      return absl::AlreadyExistsError(absl::StrCat(
          ToString(loop), constraint.is_loop
                              ? ": the map already has this loop"
                              : ": this node was inserted into this submap"));
    }
  }
  return absl::OkStatus();
}

// What is looked up of a stored map for one loop.
class StoredMap {
 public:
  explicit StoredMap(const io::Pbstream& pbstream) {
    for (const auto& record : pbstream.nodes) {
      nodes_[{record.node_id().trajectory_id(),
              record.node_id().node_index()}] = &record.node_data();
    }
    for (const auto& record : pbstream.submaps) {
      const auto& submap = record.submap_2d();
      if (!submap.has_grid() ||
          !io::FindGridProblems(submap.grid(), "").empty()) {
        continue;
      }
      submaps_[{record.submap_id().trajectory_id(),
                record.submap_id().submap_index()}] = &submap;
    }
  }

  absl::optional<TrajectoryNode::Data> Node(const GraphId& id) const {
    const auto node = nodes_.find(id);
    if (node == nodes_.end()) return absl::nullopt;
    return cartographer::mapping::FromProto(*node->second);
  }

  // Null where there is none with a grid.
  std::unique_ptr<Submap2D> Submap(const GraphId& id) {
    const auto submap = submaps_.find(id);
    if (submap == submaps_.end()) return nullptr;
    return absl::make_unique<Submap2D>(*submap->second, &tables_);
  }

  // The node and those before it (`step` -1) or behind it (1), in this order,
  // the spacing apart by local SLAM; up to one of `end`.
  std::vector<GraphId> Along(const GraphId& id, const int step,
                             const std::set<GraphId>& end,
                             const HandMatchOptions& options) const {
    std::vector<GraphId> result = {id};
    Pose2 last = loop_closure::LocalPose(*Node(id));
    for (auto at = nodes_.find(id);
         static_cast<int>(result.size()) < options.nodes_to_verify;) {
      if (step < 0 ? at == nodes_.begin() : std::next(at) == nodes_.end())
        break;
      at = step < 0 ? std::prev(at) : std::next(at);
      if (at->first.trajectory_id != id.trajectory_id ||
          end.count(at->first) > 0) {
        break;
      }
      const Pose2 pose = loop_closure::LocalPose(*Node(at->first));
      if ((pose.translation() - last.translation()).norm() < options.spacing) {
        continue;
      }
      result.push_back(at->first);
      last = pose;
    }
    return result;
  }

 private:
  std::map<GraphId, const cartographer::mapping::proto::TrajectoryNodeData*>
      nodes_;
  std::map<GraphId, const cartographer::mapping::proto::Submap2D*> submaps_;
  cartographer::mapping::ValueConversionTables tables_;
};

std::set<GraphId> Inserted(const GraphId& submap,
                           const evaluation::MapGraph& graph) {
  std::set<GraphId> nodes;
  for (const auto& constraint : graph.constraints) {
    if (!constraint.is_loop && constraint.submap_id == submap) {
      nodes.insert(constraint.node_id);
    }
  }
  return nodes;
}

// S_t of the path to the node (`step` -1), or of the one on from it (1), which
// a finished map has as well. No scan is compared with submaps it is part of.
loop_closure::TemporalResult Verify(const LoopByHand& loop, const Pose2& pose,
                                    const int step,
                                    const evaluation::MapGraph& graph,
                                    const HandMatchOptions& options,
                                    StoredMap* const map) {
  loop_closure::TemporalVerificationOptions temporal;
  // Of a short path the node itself is left.
  temporal.minimum_length = 1;
  std::list<loop_closure::HistoryNode> nodes;
  const std::vector<GraphId> path =
      map->Along(loop.node_id, step, Inserted(loop.submap_id, graph), options);
  for (const GraphId& id : path) {
    const TrajectoryNode::Data data = *map->Node(id);
    loop_closure::HistoryNode node;
    node.node_index = id.index;
    node.local_pose = loop_closure::LocalPose(data);
    loop_closure::DescribeScan(temporal, loop_closure::PlanarPoints(data),
                               &node);
    nodes.push_front(std::move(node));
  }
  std::vector<const loop_closure::HistoryNode*> query;
  for (const auto& node : nodes) query.push_back(&node);
  const evaluation::GraphSubmap& submap = graph.submaps.at(loop.submap_id);
  std::list<OccupancyView> views;
  std::vector<loop_closure::ReferenceMap> maps;
  const int num_neighbours =
      loop_closure::TemporalStageOptions().num_neighbours;
  for (int i = 0; i <= 2 * num_neighbours; ++i) {
    // 0, -1, 1, -2, 2
    const int offset = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
    const GraphId id{loop.submap_id.trajectory_id,
                     loop.submap_id.index + offset};
    const auto neighbour = map->Submap(id);
    const std::set<GraphId> inserted = Inserted(id, graph);
    if (neighbour == nullptr ||
        std::any_of(path.begin(), path.end(), [&](const GraphId& node) {
          return inserted.count(node) > 0;
        })) {
      continue;
    }
    views.push_back(
        loop_closure::MakeReferenceView(temporal, *neighbour->grid()));
    loop_closure::ReferenceMap reference;
    reference.view = &views.back();
    reference.view_from_submap = submap.local_pose;
    maps.push_back(reference);
  }
  return loop_closure::VerifySequence(temporal, query, pose, maps);
}

// (grid <- cloud), searched and refined; `initial` where the user has a pose.
SubmapMatch Search(const Submap2D& submap,
                   const cartographer::sensor::PointCloud& cloud,
                   const absl::optional<Pose2>& initial,
                   const HandMatchOptions& options) {
  const loop_closure::SubmapMatcher matcher(
      *submap.grid(), options.builder.fast_correlative_scan_matcher_options());
  SubmapMatch found =
      initial.has_value()
          ? matcher.Match(*initial, options.linear_window,
                          options.angular_window, cloud,
                          options.builder.min_score())
          : matcher.MatchFullSubmap(
                cloud, options.builder.global_localization_min_score());
  if (!found.found) return found;
  const cartographer::mapping::scan_matching::CeresScanMatcher2D refiner(
      options.builder.ceres_scan_matcher_options());
  found.pose =
      loop_closure::RefineMatch(refiner, *submap.grid(), cloud, found.pose);
  return found;
}

}  // namespace

std::string ToString(const LoopByHand& loop) {
  return evaluation::LoopName(loop.submap_id, loop.node_id);
}

absl::StatusOr<std::vector<LoopByHand>> ParseLoopsByHand(
    const evaluation::MapGraph& graph, const std::string& names) {
  std::vector<LoopByHand> loops;
  std::set<std::string> seen;
  for (const std::string& name : std::vector<std::string>(
           absl::StrSplit(names, absl::ByAnyChar(", \n"), absl::SkipEmpty()))) {
    const auto loop = Parse(name);
    if (!loop.ok()) return loop.status();
    const absl::Status status = CheckIsNew(*loop, graph);
    if (!status.ok()) return status;
    if (!seen.insert(ToString(*loop)).second) {
      return absl::InvalidArgumentError(
          absl::StrCat(ToString(*loop), " is named twice"));
    }
    loops.push_back(*loop);
  }
  return loops;
}

absl::StatusOr<HandMatch> MatchByHand(const LoopByHand& loop,
                                      const evaluation::MapGraph& graph,
                                      const io::Pbstream& pbstream,
                                      const HandMatchOptions& options) {
  StoredMap map(pbstream);
  const auto submap = map.Submap(loop.submap_id);
  const auto node = map.Node(loop.node_id);
  if (submap == nullptr || !node.has_value() ||
      node->filtered_gravity_aligned_point_cloud.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        ToString(loop), ": the map does not have both the scan and the grid"));
  }
  const Pose2 aligned_from_node = loop_closure::AlignedFromTracking(*node);
  const Pose2 grid_from_submap = graph.submaps.at(loop.submap_id).local_pose;
  absl::optional<Pose2> initial;
  if (loop.pose.has_value()) {
    initial = grid_from_submap * *loop.pose * aligned_from_node.Inverse();
  }
  const SubmapMatch found = Search(
      *submap, node->filtered_gravity_aligned_point_cloud, initial, options);
  if (!found.found) {
    return absl::NotFoundError(absl::StrCat(
        ToString(loop), ": the scan matches nowhere ",
        initial.has_value()
            ? absl::StrFormat("within %.1f m", options.linear_window)
            : "in the submap"));
  }
  HandMatch match;
  match.score = found.score;
  match.pose = Between(grid_from_submap, found.pose) * aligned_from_node;
  for (const int step : {-1, 1}) {
    const loop_closure::TemporalResult result =
        Verify(loop, match.pose, step, graph, options, &map);
    if (result.outcome != loop_closure::TemporalOutcome::kScored ||
        result.score <= match.temporal) {
      continue;
    }
    match.temporal = result.score;
    match.num_verified = result.num_query;
  }
  if (match.temporal < options.min_temporal_score) {
    return absl::NotFoundError(
        absl::StrFormat("%s: the scan scores %.2f, but it and its neighbours "
                        "do not agree with the submap (%.2f, required %.2f)",
                        ToString(loop), match.score, match.temporal,
                        options.min_temporal_score));
  }
  return match;
}

}  // namespace repair
}  // namespace cartographer_ext
