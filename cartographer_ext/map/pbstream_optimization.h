// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The robust back ends on a finished map: its pose graph as
// optimization::PoseGraph, and the result written back.
//
// Vertices are submaps and nodes. Edges are the constraints (INTER_SUBMAP ones
// are loops) and, between consecutive nodes, the motion by local SLAM with the
// stock weights of the optimisation problem. Odometry readings are not used,
// because local SLAM has already used them.
//
// Cartographer's weights are relative: 1.1e4 per metre does not mean a standard
// deviation of 0.1 mm. Kernels and gates need metric ones, so all weights are
// scaled by one factor that gives the loops `loop_sigma`.
#ifndef CARTOGRAPHER_EXT_MAP_PBSTREAM_OPTIMIZATION_H_
#define CARTOGRAPHER_EXT_MAP_PBSTREAM_OPTIMIZATION_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/optimization/graph/pose_graph.h"

namespace cartographer_ext {
namespace evaluation {

struct MapOptimizationOptions {
  double loop_sigma = 0.1;  // metres, of the translation of a loop
  double local_slam_translation_weight = 1e5;
  double local_slam_rotation_weight = 1e5;
};

struct MapPoseGraph {
  optimization::PoseGraph graph;
  // Vertex of the pose graph -> submap or node.
  std::vector<GraphId> id_of_vertex;
  std::vector<bool> vertex_is_submap;
  // Edge -> index of the constraint in the file, -1 for local SLAM.
  std::vector<int> constraint_of_edge;
};

// Vertices are in the order in which mapping created them (a submap follows the
// first node inserted in it), so that the graph can be replayed. Constraints
// with missing submaps or nodes, or without weight, are skipped. Ids are those
// of SubmapVertexId and NodeVertexId. The graph is checked.
absl::StatusOr<MapPoseGraph> MakeMapPoseGraph(
    const MapGraph& map, const MapOptimizationOptions& options);

// Replaces the global poses in `pbstream` by those of the vertices; height,
// roll and pitch are kept. Landmarks are unchanged.
void StorePoses(const MapPoseGraph& graph, const std::vector<Pose2>& poses,
                io::Pbstream* pbstream);

// Removes the constraints with these indices.
void DropConstraints(const std::vector<int>& indices,
                     cartographer::mapping::proto::PoseGraph* pose_graph);
void DropConstraints(const std::vector<int>& indices, io::Pbstream* pbstream);

// Indices of the loops named by
// "submap_trajectory:submap:node_trajectory:node", comma separated. An error
// for malformed names and for loops that the map does not have.
absl::StatusOr<std::vector<int>> FindLoops(const MapGraph& map,
                                           const std::string& names);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_PBSTREAM_OPTIMIZATION_H_
