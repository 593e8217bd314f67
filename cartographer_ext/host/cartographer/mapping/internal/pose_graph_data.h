// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The data of a pose graph.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_POSE_GRAPH_DATA_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_POSE_GRAPH_DATA_H_

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/internal/trajectory_connectivity_state.h"
#include "cartographer/mapping/internal/trajectory_states.h"
#include "cartographer/mapping/pose_graph.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer/mapping/submaps.h"

namespace cartographer {
namespace mapping {

// Unfinished submaps are not searched for loop closures.
enum class SubmapState { kNoConstraintSearch, kFinished };

struct InternalSubmapData {
  std::shared_ptr<const Submap> submap;
  SubmapState state = SubmapState::kNoConstraintSearch;
  // The nodes the submap was built from.
  std::set<NodeId> node_ids;
};

struct PoseGraphData {
  // All submaps and nodes, including those that still wait in the work queue.
  MapById<SubmapId, InternalSubmapData> submap_data;
  MapById<NodeId, TrajectoryNode> trajectory_nodes;
  // How many nodes local SLAM has added in total.
  int num_trajectory_nodes = 0;

  // As of the last optimisation.
  MapById<SubmapId, optimization::SubmapSpec2D> global_submap_poses_2d;

  TrajectoryStates trajectory_states;
  std::map<int, PoseGraph::InitialTrajectoryPose> initial_trajectory_poses;
  std::map<int, PoseGraphInterface::TrajectoryData> trajectory_data;
  TrajectoryConnectivityState trajectory_connectivity_state;

  std::map<std::string /* landmark ID */, PoseGraphInterface::LandmarkNode>
      landmark_nodes;

  std::vector<PoseGraphInterface::Constraint> constraints;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_POSE_GRAPH_DATA_H_
