// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The pose graph of a finished map in plain types, for metrics, exporters and
// loop statistics. All poses are x, y and yaw, and a node represents the
// tracking frame at its stamp, so that poses of nodes can be compared with each
// other and with ground truth. (In the host it represents the gravity-aligned
// frame, whose yaw against the tracking frame differs from node to node.)
// Submaps being level,
//   relative_pose = submap_pose^-1 * node_pose
// also holds for the yaw, regardless of the tilt.
#ifndef CARTOGRAPHER_EXT_MAP_MAP_GRAPH_H_
#define CARTOGRAPHER_EXT_MAP_MAP_GRAPH_H_

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

// Of a node or a submap.
struct GraphId {
  int trajectory_id = 0;
  int index = 0;

  bool operator==(const GraphId& other) const {
    return trajectory_id == other.trajectory_id && index == other.index;
  }
  bool operator!=(const GraphId& other) const { return !(*this == other); }
  bool operator<(const GraphId& other) const {
    return std::tie(trajectory_id, index) <
           std::tie(other.trajectory_id, other.index);
  }
};

// For example "(0, 17)".
std::string ToString(const GraphId& id);

// "submap_trajectory:submap:node_trajectory:node", as used by the commands.
std::string LoopName(const GraphId& submap_id, const GraphId& node_id);

struct GraphNode {
  io::TimeNs time = 0;
  Pose2 local_pose;   // (local frame of the trajectory <- node)
  Pose2 global_pose;  // (map <- node), optimised
  // (map <- node) including the tilt that the planar poses omit.
  Eigen::Isometry3d global_tracking_pose = Eigen::Isometry3d::Identity();
  // From the records of local SLAM (MarkMatches), not stored in maps: the
  // degenerate direction of the scan (radians, map frame).
  bool weak_direction_is_known = false;
  double weak_direction = 0.;
  bool odometry_fault = false;
};

struct GraphSubmap {
  Pose2 local_pose;   // (local frame of the trajectory <- submap)
  Pose2 global_pose;  // (map <- submap), optimised
  bool finished = false;
  int num_range_data = 0;
};

struct GraphConstraint {
  GraphId submap_id;
  GraphId node_id;
  Pose2 relative_pose;  // (submap <- node)
  double translation_weight = 0.;
  double rotation_weight = 0.;
  bool is_loop = false;  // INTER_SUBMAP: found by search, not by insertion
  // Disabled in the last optimisation (MarkSwitchedOff); not stored in files.
  bool switched_off = false;
};

struct MapGraph {
  std::map<GraphId, GraphNode> nodes;
  std::map<GraphId, GraphSubmap> submaps;
  std::vector<GraphConstraint> constraints;  // in the order of the file

  int64_t num_loops() const;
  // (map <- tracking frame) at the nodes of one trajectory.
  Trajectory GlobalTrajectory(int trajectory_id) const;
  // (map <- tracking frame) at the nodes of all trajectories.
  Trajectory GlobalTrajectory() const;
  // (local <- node) at the nodes of one trajectory, planar.
  Trajectory LocalTrajectory(int trajectory_id) const;
  // Trajectories of which a constraint ties a node to a submap.
  std::set<int> TiedTrajectories() const;
  // Nodes inserted into each submap, in order of id, from the intra-submap
  // constraints.
  std::map<GraphId, std::vector<GraphId>> InsertedNodes() const;
};

// Residual of a constraint against the poses of the graph: (constraint)^-1 *
// (submap^-1 * node), with the optimised poses.
Pose2 Residual(const GraphConstraint& constraint, const GraphSubmap& submap,
               const GraphNode& node);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_MAP_GRAPH_H_
