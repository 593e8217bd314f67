// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The submaps of a map as the scans inserted in them saw them, which of them a
// scan meets at another time, and whether that is on another visit.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_PLACED_SUBMAPS_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_PLACED_SUBMAPS_H_

#include <functional>
#include <map>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// Two places this close, in metres, are one.
constexpr double kVisitDistance = 2.;

// True if the robot has not come back between two poses: what it has travelled is
// less than twice their distance, allowing for `visit_distance`. All in metres.
// What it sees on one visit is aligned by local SLAM alone: it tells how local SLAM fares (or that the ground is not
// level and things have no clear outline), not whether the parts of the map are
// in place.
inline bool IsOneVisit(const double travelled, const double distance,
                       const double visit_distance) {
  return travelled < 2. * (distance + visit_distance);
}

// Length of the path of local SLAM up to each node of a map.
class TravelledPath {
 public:
  explicit TravelledPath(const MapGraph& graph);

  // Whether two nodes, `distance` metres apart in the map, are of one visit;
  // false if they are of different trajectories or unknown.
  bool AreOneVisit(const GraphId& a, const GraphId& b, double distance,
                   double visit_distance) const;

 private:
  std::map<GraphId, double> metres_;  // from the start of the trajectory
};

// Axis-aligned box in the map frame.
struct Box {
  Eigen::Vector2d min, max;
  bool Meets(const Box& other) const {
    return (min.array() <= other.max.array()).all() &&
           (other.min.array() <= max.array()).all();
  }
};

// A submap as seen from a node inserted in it. The optimisation moves the nodes
// of a submap against each other: where a long submap is bent, its far end as
// drawn lies elsewhere than the scans it was drawn from.
struct Anchor {
  GraphId node_id;
  Eigen::Vector2d place;  // of the node, map frame
  Pose2 local_from_map;   // of the submap, by the poses of this node
};

struct PlacedSubmap {
  GraphId id;
  const SubmapCells* cells;
  std::vector<Anchor> anchors;  // at least one, by node
  // Standard deviation of the headings that they give it, radians.
  double heading_sigma;
  Box box;  // by the pose of the submap

  const Anchor& NearestAnchor(const Eigen::Vector2d& place) const;
  // As the inserted node nearest to a place saw it.
  const Pose2& LocalFromMap(const Eigen::Vector2d& place) const {
    return NearestAnchor(place).local_from_map;
  }
  // True if the node was not inserted and is no nearer in the sequence than
  // `min_node_gap` to one that was.
  bool IsOfAnotherTime(const GraphId& node_id, int min_node_gap) const;
};

// Submaps without a grid or without inserted nodes are left out. `contents` must
// outlive the result.
std::vector<PlacedSubmap> PlaceSubmaps(const MapGraph& graph,
                                       const MapContents& contents);

// Calls `visit` for every submap of another time whose box the scan of the node
// meets at its pose in the map; never if the node has no scan.
void ForEachSubmapOfAnotherTime(
    const std::vector<PlacedSubmap>& submaps, const MapContents& contents,
    const GraphId& node_id, const Pose2& pose, int min_node_gap,
    const std::function<void(const PlacedSubmap&)>& visit);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_PLACED_SUBMAPS_H_
