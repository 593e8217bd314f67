// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/verdict/placed_submaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cartographer_ext/common/squared.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

Box BoxOf(const std::vector<Eigen::Vector2d>& points) {
  Box box{points.front(), points.front()};
  for (const Eigen::Vector2d& point : points) {
    box.min = box.min.cwiseMin(point);
    box.max = box.max.cwiseMax(point);
  }
  return box;
}

Box SubmapBox(const SubmapCells& cells, const Pose2& map_from_local) {
  const Eigen::Vector2d low = cells.min_corner(), high = cells.max_corner();
  return BoxOf({map_from_local * low,
                map_from_local * Eigen::Vector2d(low.x(), high.y()),
                map_from_local * Eigen::Vector2d(high.x(), low.y()),
                map_from_local * high});
}

Box ScanBox(const std::vector<Eigen::Vector2d>& scan, const Pose2& pose) {
  std::vector<Eigen::Vector2d> points = {pose.translation()};
  for (const Eigen::Vector2d& point : scan) points.push_back(pose * point);
  return BoxOf(points);
}

double HeadingSigma(const std::vector<Anchor>& anchors) {
  const auto count = static_cast<double>(anchors.size());
  double sum = 0., squares = 0.;
  for (const Anchor& anchor : anchors) {
    const double turn = NormalizeAngle(anchor.local_from_map.theta -
                                       anchors.front().local_from_map.theta);
    sum += turn;
    squares += Squared(turn);
  }
  return std::sqrt(std::max(0., squares / count - Squared(sum / count)));
}

}  // namespace

TravelledPath::TravelledPath(const MapGraph& graph) {
  const std::pair<const GraphId, GraphNode>* last = nullptr;
  double metres = 0.;
  for (const auto& node : graph.nodes) {
    const bool continues = last != nullptr && last->first.trajectory_id ==
                                                  node.first.trajectory_id;
    metres = continues ? metres + (node.second.local_pose.translation() -
                                   last->second.local_pose.translation())
                                      .norm()
                       : 0.;
    metres_[node.first] = metres;
    last = &node;
  }
}

bool TravelledPath::AreOneVisit(const GraphId& a, const GraphId& b,
                                const double distance,
                                const double visit_distance) const {
  const auto first = metres_.find(a), second = metres_.find(b);
  if (a.trajectory_id != b.trajectory_id || first == metres_.end() ||
      second == metres_.end()) {
    return false;
  }
  return IsOneVisit(std::abs(first->second - second->second), distance,
                    visit_distance);
}

const Anchor& PlacedSubmap::NearestAnchor(const Eigen::Vector2d& place) const {
  const Anchor* nearest = nullptr;
  double least = 0.;
  for (const Anchor& anchor : anchors) {
    const double distance = (anchor.place - place).squaredNorm();
    if (nearest != nullptr && !(distance < least)) continue;
    nearest = &anchor;
    least = distance;
  }
  return *nearest;
}

bool PlacedSubmap::IsOfAnotherTime(const GraphId& node_id,
                                   const int min_node_gap) const {
  return id.trajectory_id != node_id.trajectory_id ||
         node_id.index <= anchors.front().node_id.index - min_node_gap ||
         node_id.index >= anchors.back().node_id.index + min_node_gap;
}

std::vector<PlacedSubmap> PlaceSubmaps(const MapGraph& graph,
                                       const MapContents& contents) {
  std::map<GraphId, std::vector<Anchor>> anchors;
  for (const GraphConstraint& constraint : graph.constraints) {
    if (constraint.is_loop) continue;
    const auto submap = graph.submaps.find(constraint.submap_id);
    const auto node = graph.nodes.find(constraint.node_id);
    if (submap == graph.submaps.end() || node == graph.nodes.end()) continue;
    const Pose2& pose = node->second.global_pose;
    anchors[constraint.submap_id].push_back(
        {constraint.node_id, pose.translation(),
         submap->second.local_pose * constraint.relative_pose *
             pose.Inverse()});
  }
  std::vector<PlacedSubmap> placed;
  for (auto& entry : anchors) {
    const auto cells = contents.submaps.find(entry.first);
    if (cells == contents.submaps.end()) continue;
    std::sort(
        entry.second.begin(), entry.second.end(),
        [](const Anchor& a, const Anchor& b) { return a.node_id < b.node_id; });
    const double heading_sigma = HeadingSigma(entry.second);
    placed.push_back({entry.first, &cells->second, std::move(entry.second),
                      heading_sigma,
                      SubmapBox(cells->second,
                                MapFromLocal(graph.submaps.at(entry.first)))});
  }
  return placed;
}

void ForEachSubmapOfAnotherTime(
    const std::vector<PlacedSubmap>& submaps, const MapContents& contents,
    const GraphId& node_id, const Pose2& pose, const int min_node_gap,
    const std::function<void(const PlacedSubmap&)>& visit) {
  const auto scan = contents.scans.find(node_id);
  if (scan == contents.scans.end() || scan->second.empty()) return;
  const Box box = ScanBox(scan->second, pose);
  for (const PlacedSubmap& submap : submaps) {
    if (submap.IsOfAnotherTime(node_id, min_node_gap) &&
        box.Meets(submap.box)) {
      visit(submap);
    }
  }
}

}  // namespace evaluation
}  // namespace cartographer_ext
