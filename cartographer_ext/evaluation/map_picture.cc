// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/evaluation/map_picture.h"

#include <map>
#include <vector>

#include "cartographer_ext/io/picture.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kLargeResidual = 0.5;  // metres

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

}  // namespace

absl::Status WriteMapPicture(const io::OccupancyMap& map, const MapGraph& graph,
                             const std::string& title,
                             const std::string& filename) {
  io::PictureBounds bounds;
  bounds.Add(map);
  for (const auto& entry : graph.nodes) {
    bounds.Add(entry.second.global_pose.translation());
  }
  io::Picture picture(bounds);
  picture.DrawMap(map);

  const auto inserted = graph.InsertedNodes();
  bool has_loops = false, has_large = false;
  // Those that agree first: the others are what one looks for.
  for (const bool large : {false, true}) {
    for (const GraphConstraint& constraint : graph.constraints) {
      const auto submap = graph.submaps.find(constraint.submap_id);
      const auto node = graph.nodes.find(constraint.node_id);
      if (!constraint.is_loop || submap == graph.submaps.end() ||
          node == graph.nodes.end()) {
        continue;
      }
      const Pose2 residual = Residual(constraint, submap->second, node->second);
      if ((residual.translation().norm() > kLargeResidual) != large) continue;
      (large ? has_large : has_loops) = true;
      io::LineStyle style;
      style.color = large ? io::palette::kVermilion : io::palette::kSkyBlue;
      style.color.alpha = large ? 0.9 : 0.35;
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
  if (has_loops) picture.AddLegend("loop", io::palette::kSkyBlue);
  if (has_large) {
    picture.AddLegend("loop against the map", io::palette::kVermilion);
  }
  return picture.Write(filename);
}

}  // namespace evaluation
}  // namespace cartographer_ext
