// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/map_picture.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cartographer_ext/io/picture.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kLargeResidual = 0.5;  // metres

enum class LoopKind { kAgrees, kAgainstTheMap, kSwitchedOff };

LoopKind KindOf(const GraphConstraint& constraint, const GraphSubmap& submap,
                const GraphNode& node) {
  if (constraint.switched_off) return LoopKind::kSwitchedOff;
  const Pose2 residual = Residual(constraint, submap, node);
  return residual.translation().norm() > kLargeResidual
             ? LoopKind::kAgainstTheMap
             : LoopKind::kAgrees;
}

io::Color ColorOf(const LoopKind kind) {
  switch (kind) {
    case LoopKind::kAgrees:
      return io::palette::kSkyBlue;
    case LoopKind::kAgainstTheMap:
      return io::palette::kVermilion;
    case LoopKind::kSwitchedOff:
      return io::palette::kPurple;
  }
  return io::palette::kGrey;
}

// Where a submap was begun, to draw lines to: the first inserted node rather
// than the origin of the submap, which may lie outside the room.
Eigen::Vector2d Anchor(
    const MapGraph& graph, const GraphId& submap_id,
    const std::map<GraphId, std::vector<GraphId>>& inserted) {
  const auto it = inserted.find(submap_id);
  return it == inserted.end()
             ? graph.submaps.at(submap_id).global_pose.translation()
             : graph.nodes.at(it->second[it->second.size() / 2])
                   .global_pose.translation();
}

// What local SLAM was not sure of.
void DrawMarks(const MapGraph& graph, io::Picture* const picture) {
  constexpr double kDash = 0.3;  // metres, half its length
  bool has_weak = false, has_fault = false;
  for (const auto& entry : graph.nodes) {
    const GraphNode& node = entry.second;
    const Eigen::Vector2d place = node.global_pose.translation();
    if (node.weak_direction_is_known) {
      const Eigen::Vector2d dash(kDash * std::cos(node.weak_direction),
                                 kDash * std::sin(node.weak_direction));
      picture->DrawLine(place - dash, place + dash,
                        {io::palette::kOrange, 3., false});
      has_weak = true;
    }
    if (node.odometry_fault) {
      picture->DrawDot(place, 4., io::palette::kVermilion);
      has_fault = true;
    }
  }
  if (has_weak) {
    picture->AddLegend("degenerate scan", io::palette::kOrange);
  }
  if (has_fault) picture->AddLegend("odometry fault", io::palette::kVermilion);
}

}  // namespace

absl::Status WriteMapPicture(io::OccupancyMap map, const MapGraph& graph,
                             const std::string& title,
                             const std::string& filename) {
  io::PictureBounds bounds;
  bounds.Add(map);
  for (const auto& entry : graph.nodes) {
    bounds.Add(entry.second.global_pose.translation());
  }
  io::Picture picture(bounds);
  picture.DrawMap(std::move(map));

  const auto inserted = graph.InsertedNodes();
  // Consistent loops first, so that the others are drawn over them.
  std::map<LoopKind, bool> present;
  for (const LoopKind kind :
       {LoopKind::kAgrees, LoopKind::kAgainstTheMap, LoopKind::kSwitchedOff}) {
    for (const GraphConstraint& constraint : graph.constraints) {
      const auto submap = graph.submaps.find(constraint.submap_id);
      const auto node = graph.nodes.find(constraint.node_id);
      if (!constraint.is_loop || submap == graph.submaps.end() ||
          node == graph.nodes.end() ||
          KindOf(constraint, submap->second, node->second) != kind) {
        continue;
      }
      present[kind] = true;
      io::LineStyle style;
      style.color = ColorOf(kind);
      style.color.alpha = kind == LoopKind::kAgrees ? 0.35 : 0.9;
      style.width = 1.;
      picture.DrawLine(Anchor(graph, constraint.submap_id, inserted),
                       node->second.global_pose.translation(), style);
    }
  }
  std::map<int, std::vector<Eigen::Vector2d>> paths;
  for (const auto& entry : graph.nodes) {
    paths[entry.first.trajectory_id].push_back(
        entry.second.global_pose.translation());
  }
  for (const auto& path : paths) {
    picture.DrawPolyline(path.second, {io::palette::kBlue, 1.5, false});
  }
  if (!title.empty()) picture.SetTitle(title);
  picture.AddLegend("path", io::palette::kBlue);
  DrawMarks(graph, &picture);
  const std::map<LoopKind, const char*> legends = {
      {LoopKind::kAgrees, "loop"},
      {LoopKind::kAgainstTheMap, "loop that contradicts the map"},
      {LoopKind::kSwitchedOff, "disabled loop"}};
  for (const auto& legend : legends) {
    if (present[legend.first]) {
      picture.AddLegend(legend.second, ColorOf(legend.first));
    }
  }
  return picture.Write(filename);
}

}  // namespace evaluation
}  // namespace cartographer_ext
