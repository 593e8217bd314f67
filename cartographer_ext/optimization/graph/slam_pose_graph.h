// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The pose graph that Cartographer optimizes, as the PoseGraph of this module.
//
// Vertices are nodes and submaps, in the order in which mapping creates them (a
// submap follows the first node inserted in it), so that the graph can be
// replayed. Edges are
//
//   constraints   submap -> node; those of tag INTER_SUBMAP are loops
//   local SLAM    node -> next node of the trajectory, with the local SLAM
//                 weights of the optimization problem
//   frozen        vertex 0 -> each vertex of a frozen trajectory, which holds
//                 it fixed
//
// Odometry readings are not used, because local SLAM has already used them.
//
// Cartographer's weights are relative: 1.1e4 per metre does not mean a standard
// deviation of 0.1 mm. Kernels and gates need standard deviations in metres, so
// one factor scales all weights such that the median loop has `loop_sigma`.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_SLAM_POSE_GRAPH_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_SLAM_POSE_GRAPH_H_

#include <set>
#include <utility>
#include <vector>

#include "cartographer_ext/common/loop_id.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace optimization {

// Trajectory and index of a node or of a submap.
using SlamId = std::pair<int, int>;

// A node of the host.
struct SlamNode {
  SlamId id;
  Pose2 local_pose;   // (local frame of the trajectory <- node)
  Pose2 global_pose;  // (map <- node)
};

// A submap of the host.
struct SlamSubmap {
  SlamId id;
  Pose2 global_pose;  // (map <- submap)
};

// A constraint of the host.
struct SlamConstraint {
  LoopId id;            // submap and node
  Pose2 relative_pose;  // (submap <- node)
  double translation_weight = 0.;
  double rotation_weight = 0.;
  bool is_loop = false;
};

// The pose graph of the host in plain types.
struct SlamGraph {
  std::vector<SlamNode> nodes;      // ascending ids
  std::vector<SlamSubmap> submaps;  // ascending ids
  std::vector<SlamConstraint> constraints;
  std::set<int> frozen_trajectories;
};

// Scale and weights of the edges.
struct SlamPoseGraphOptions {
  double loop_sigma = 0.1;  // metres, of the translation of the median loop
  // Zero: no edges of local SLAM.
  double local_slam_translation_weight = 1e5;
  double local_slam_rotation_weight = 1e5;
};

// The pose graph with its relation to the host.
struct SlamPoseGraph {
  PoseGraph graph;  // ids are indices
  // Per vertex, an index in SlamGraph::submaps or ::nodes.
  struct Vertex {
    bool is_submap = false;
    int index = 0;
  };
  std::vector<Vertex> vertices;
  // Per edge, an index in SlamGraph::constraints, -1 for all others.
  std::vector<int> constraint_of_edge;
  std::vector<int> local_slam_edges;
};

// Constraints without weight, or with submaps or nodes that are not in the
// graph, have no edge.
SlamPoseGraph MakeSlamPoseGraph(const SlamGraph& slam,
                                const SlamPoseGraphOptions& options);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_GRAPH_SLAM_POSE_GRAPH_H_
