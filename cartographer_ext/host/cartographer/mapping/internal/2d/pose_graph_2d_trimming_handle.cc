// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/pose_graph_2d_trimming_handle.h"

#include <algorithm>
#include <utility>

#include "cartographer/mapping/internal/2d/pose_graph_2d_metrics.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

PoseGraph2D::TrimmingHandle::TrimmingHandle(PoseGraph2D* const parent)
    : parent_(parent), data_(parent->data_) {}

int PoseGraph2D::TrimmingHandle::num_submaps(const int trajectory_id) const {
  return parent_->optimization_problem_->submap_data().SizeOfTrajectoryOrZero(
      trajectory_id);
}

std::vector<SubmapId> PoseGraph2D::TrimmingHandle::GetSubmapIds(
    const int trajectory_id) const {
  std::vector<SubmapId> ids;
  for (const auto& submap :
       parent_->optimization_problem_->submap_data().trajectory(
           trajectory_id)) {
    ids.push_back(submap.id);
  }
  return ids;
}

MapById<SubmapId, PoseGraphInterface::SubmapData>
PoseGraph2D::TrimmingHandle::GetOptimizedSubmapData() const {
  MapById<SubmapId, PoseGraphInterface::SubmapData> result;
  for (const auto& optimized : data_.global_submap_poses_2d) {
    const InternalSubmapData& submap = data_.submap_data.at(optimized.id);
    if (submap.state == SubmapState::kFinished) {
      result.Insert(optimized.id,
                    SubmapData{submap.submap,
                               transform::Embed3D(optimized.data.global_pose)});
    }
  }
  return result;
}

const MapById<NodeId, TrajectoryNode>&
PoseGraph2D::TrimmingHandle::GetTrajectoryNodes() const {
  return data_.trajectory_nodes;
}

const std::vector<PoseGraphInterface::Constraint>&
PoseGraph2D::TrimmingHandle::GetConstraints() const {
  return data_.constraints;
}

bool PoseGraph2D::TrimmingHandle::IsFinished(const int trajectory_id) const {
  parent_->mutex_.AssertHeld();
  return data_.trajectory_states.Is(trajectory_id, TrajectoryState::FINISHED);
}

void PoseGraph2D::TrimmingHandle::SetTrajectoryState(
    const int trajectory_id, const PoseGraphInterface::TrajectoryState state) {
  data_.trajectory_states.Set(trajectory_id, state);
}

void PoseGraph2D::TrimmingHandle::TrimSubmap(const SubmapId& submap_id) {
  parent_->mutex_.AssertHeld();
  CHECK(data_.submap_data.at(submap_id).state == SubmapState::kFinished)
      << "submap " << submap_id << " is unfinished";
  const std::set<NodeId> node_ids = NodesOnlyIn(submap_id);
  RemoveConstraints(submap_id, node_ids);
  parent_->constraint_builder_.DeleteScanMatcher(submap_id);
  data_.submap_data.Trim(submap_id);
  if (data_.global_submap_poses_2d.Contains(submap_id)) {
    data_.global_submap_poses_2d.Trim(submap_id);
  }
  parent_->optimization_problem_->TrimSubmap(submap_id);
  for (const NodeId& node_id : node_ids) {
    data_.trajectory_nodes.Trim(node_id);
    parent_->optimization_problem_->TrimTrajectoryNode(node_id);
  }
  data_.trajectory_data = parent_->optimization_problem_->trajectory_data();

  PoseGraph2DMetrics& metrics = GetPoseGraph2DMetrics();
  metrics.deleted_submaps->Increment();
  const bool is_frozen = data_.trajectory_states.Is(submap_id.trajectory_id,
                                                    TrajectoryState::FROZEN);
  (is_frozen ? metrics.frozen_submaps : metrics.active_submaps)->Decrement();
}

std::set<NodeId> PoseGraph2D::TrimmingHandle::NodesOnlyIn(
    const SubmapId& submap_id) const {
  std::set<NodeId> result = data_.submap_data.at(submap_id).node_ids;
  for (const auto& other : data_.submap_data) {
    if (result.empty()) {
      break;
    }
    if (other.id != submap_id) {
      for (const NodeId& node_id : other.data.node_ids) {
        result.erase(node_id);
      }
    }
  }
  return result;
}

void PoseGraph2D::TrimmingHandle::RemoveConstraints(
    const SubmapId& submap_id, const std::set<NodeId>& node_ids) {
  std::set<SubmapId> lost_nodes;
  std::set<SubmapId> with_loop_closures;
  std::vector<Constraint> kept;
  kept.reserve(data_.constraints.size());
  for (const Constraint& constraint : data_.constraints) {
    if (constraint.submap_id == submap_id) {
      continue;
    }
    if (node_ids.count(constraint.node_id) > 0) {
      lost_nodes.insert(constraint.submap_id);
      continue;
    }
    if (constraint.tag == Constraint::INTER_SUBMAP) {
      with_loop_closures.insert(constraint.submap_id);
    }
    kept.push_back(constraint);
  }
  data_.constraints = std::move(kept);
  for (const SubmapId& id : lost_nodes) {
    if (with_loop_closures.count(id) == 0) {
      parent_->constraint_builder_.DeleteScanMatcher(id);
    }
  }
}

}  // namespace mapping
}  // namespace cartographer
