// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of PoseGraph2D that takes in data other than new nodes and changes
// the state of trajectories.
#include <algorithm>
#include <iterator>
#include <utility>

#include "cartographer/mapping/internal/2d/node_spec.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d_metrics.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
// Sensor data other than nodes.

void PoseGraph2D::AddChangeOf(const int trajectory_id,
                              const std::function<void()>& change) {
  AddChange([this, trajectory_id, change]() {
    mutex_.AssertHeld();
    if (data_.trajectory_states.AcceptsData(trajectory_id)) {
      change();
      return;
    }
    LOG_EVERY_N(WARNING, 100) << "data of trajectory " << trajectory_id
                              << " is dropped, as the trajectory is complete";
  });
}

void PoseGraph2D::AddImuData(const int trajectory_id,
                             const sensor::ImuData& imu_data) {
  AddChangeOf(trajectory_id, [this, trajectory_id, imu_data]() {
    optimization_problem_->AddImuData(trajectory_id, imu_data);
  });
}

void PoseGraph2D::AddOdometryData(const int trajectory_id,
                                  const sensor::OdometryData& odometry_data) {
  AddChangeOf(trajectory_id, [this, trajectory_id, odometry_data]() {
    optimization_problem_->AddOdometryData(trajectory_id, odometry_data);
  });
}

void PoseGraph2D::AddFixedFramePoseData(
    const int trajectory_id,
    const sensor::FixedFramePoseData& fixed_frame_pose_data) {
  AddChangeOf(trajectory_id, [this, trajectory_id, fixed_frame_pose_data]() {
    optimization_problem_->AddFixedFramePoseData(trajectory_id,
                                                 fixed_frame_pose_data);
  });
}

void PoseGraph2D::AddLandmarkData(const int trajectory_id,
                                  const sensor::LandmarkData& landmark_data) {
  AddChangeOf(trajectory_id, [this, trajectory_id, landmark_data]() {
    mutex_.AssertHeld();
    for (const auto& seen : landmark_data.landmark_observations) {
      LandmarkNode::LandmarkObservation observation;
      observation.trajectory_id = trajectory_id;
      observation.time = landmark_data.time;
      observation.landmark_to_tracking_transform =
          seen.landmark_to_tracking_transform;
      observation.translation_weight = seen.translation_weight;
      observation.rotation_weight = seen.rotation_weight;
      data_.landmark_nodes[seen.id].landmark_observations.push_back(
          observation);
    }
  });
}

void PoseGraph2D::SetLandmarkPose(const std::string& landmark_id,
                                  const transform::Rigid3d& global_pose,
                                  const bool frozen) {
  AddChange([this, landmark_id, global_pose, frozen]() {
    mutex_.AssertHeld();
    LandmarkNode& landmark = data_.landmark_nodes[landmark_id];
    landmark.frozen = frozen;
    landmark.global_landmark_pose = global_pose;
  });
}

void PoseGraph2D::SetInitialTrajectoryPose(const int from_trajectory_id,
                                           const int to_trajectory_id,
                                           const transform::Rigid3d& pose,
                                           const common::Time time) {
  absl::MutexLock lock(&mutex_);
  data_.initial_trajectory_poses[from_trajectory_id] =
      InitialTrajectoryPose{to_trajectory_id, pose, time};
}

void PoseGraph2D::AddTrimmer(std::unique_ptr<PoseGraphTrimmer> trimmer) {
  // A shared pointer, because std::function must be copyable.
  auto shared =
      std::make_shared<std::unique_ptr<PoseGraphTrimmer>>(std::move(trimmer));
  AddWorkItem([this, shared]() {
    trimmers_.push_back(std::move(*shared));
    return WorkItem::Result::kDoNotRunOptimization;
  });
}

void PoseGraph2D::SetGlobalSlamOptimizationCallback(
    PoseGraphInterface::GlobalSlamOptimizationCallback callback) {
  absl::MutexLock lock(&mutex_);
  optimization_callback_ = callback;
}

// The life of trajectories.

void PoseGraph2D::FinishTrajectory(const int trajectory_id) {
  const auto finish = [this, trajectory_id]() {
    mutex_.AssertHeld();
    if (data_.trajectory_states.Is(trajectory_id, TrajectoryState::FINISHED)) {
      LOG(WARNING) << "trajectory " << trajectory_id << " is finished already";
    }
    data_.trajectory_states.Set(trajectory_id, TrajectoryState::FINISHED);
    for (const SubmapId& id : SubmapIds(trajectory_id)) {
      data_.submap_data.at(id).state = SubmapState::kFinished;
    }
  };
  AddChange(finish, WorkItem::Result::kRunOptimization);
}

std::vector<SubmapId> PoseGraph2D::SubmapIds(const int trajectory_id) const {
  std::vector<SubmapId> ids;
  for (const auto& submap : data_.submap_data.trajectory(trajectory_id)) {
    ids.push_back(submap.id);
  }
  return ids;
}

void PoseGraph2D::FreezeTrajectory(const int trajectory_id) {
  {
    absl::MutexLock lock(&mutex_);
    data_.trajectory_connectivity_state.Add(trajectory_id);
  }
  AddChange([this, trajectory_id]() {
    mutex_.AssertHeld();
    // Frozen trajectories do not move against each other, so they count as
    // connected, but for too long to be a recent connection.
    for (const auto& id_state : data_.trajectory_states.all()) {
      TrajectoryConnectivityState& connectivity =
          data_.trajectory_connectivity_state;
      const bool is_new =
          !connectivity.TransitivelyConnected(trajectory_id, id_state.first);
      if (is_new && id_state.second == TrajectoryState::FROZEN) {
        connectivity.Connect(trajectory_id, id_state.first,
                             common::FromUniversal(0));
      }
    }
    data_.trajectory_states.Set(trajectory_id, TrajectoryState::FROZEN);
  });
}

void PoseGraph2D::DeleteTrajectory(const int trajectory_id) {
  {
    absl::MutexLock lock(&mutex_);
    if (!data_.trajectory_states.Contains(trajectory_id)) {
      LOG(WARNING) << "there is no trajectory " << trajectory_id
                   << " to delete";
      return;
    }
  }
  AddChange([this, trajectory_id]() {
    mutex_.AssertHeld();
    LOG_IF(ERROR, !data_.trajectory_states.ConfirmDeletion(trajectory_id))
        << "trajectory " << trajectory_id
        << " cannot be deleted: it is neither finished nor frozen";
  });
}

bool PoseGraph2D::IsTrajectoryFinished(const int trajectory_id) const {
  return IsInState(trajectory_id, TrajectoryState::FINISHED);
}

bool PoseGraph2D::IsTrajectoryFrozen(const int trajectory_id) const {
  return IsInState(trajectory_id, TrajectoryState::FROZEN);
}

bool PoseGraph2D::IsInState(const int trajectory_id,
                            const TrajectoryState state) const {
  absl::MutexLock lock(&mutex_);
  return data_.trajectory_states.Is(trajectory_id, state);
}

// Stored states.

void PoseGraph2D::AddSubmapFromProto(
    const transform::Rigid3d& global_submap_pose, const proto::Submap& submap) {
  if (!submap.has_submap_2d()) {
    return;
  }
  const SubmapId id{submap.submap_id().trajectory_id(),
                    submap.submap_id().submap_index()};
  const optimization::SubmapSpec2D spec{
      transform::Project2D(global_submap_pose)};
  InternalSubmapData data;
  {
    // The conversion tables are shared by all submaps.
    absl::MutexLock lock(&mutex_);
    data.submap = std::make_shared<const Submap2D>(submap.submap_2d(),
                                                   &conversion_tables_);
    // Visible at once, even before anything is optimised.
    AddTrajectoryIfNeeded(id.trajectory_id);
    data_.global_submap_poses_2d.Insert(id, spec);
    data_.submap_data.Insert(id, data);
  }
  AddChange([this, id, spec]() {
    mutex_.AssertHeld();
    optimization_problem_->InsertSubmap(id, spec.global_pose);
    data_.submap_data.at(id).state = SubmapState::kFinished;
    CountNewSubmap(id.trajectory_id);
  });
}

void PoseGraph2D::CountNewSubmap(const int trajectory_id) const {
  const PoseGraph2DMetrics& metrics = GetPoseGraph2DMetrics();
  if (data_.trajectory_states.Is(trajectory_id, TrajectoryState::FROZEN)) {
    metrics.frozen_submaps->Increment();
  } else {
    metrics.active_submaps->Increment();
  }
}

void PoseGraph2D::AddNodeFromProto(const transform::Rigid3d& global_pose,
                                   const proto::Node& node) {
  const NodeId id{node.node_id().trajectory_id(), node.node_id().node_index()};
  const TrajectoryNode added{
      std::make_shared<const TrajectoryNode::Data>(FromProto(node.node_data())),
      global_pose};
  {
    absl::MutexLock lock(&mutex_);
    AddTrajectoryIfNeeded(id.trajectory_id);
    data_.trajectory_nodes.Insert(id, added);
  }
  AddChange([this, id, added]() {
    mutex_.AssertHeld();
    const TrajectoryNode::Data& constant_data = *added.constant_data;
    const transform::Rigid2d global_pose_2d =
        GravityAlignedPose2D(added.global_pose, constant_data);
    optimization_problem_->InsertTrajectoryNode(
        id, MakeNodeSpec(constant_data, global_pose_2d));
    CopyTrajectoryDataOfNew(id.trajectory_id);
  });
}

void PoseGraph2D::CopyTrajectoryDataOfNew(const int trajectory_id) {
  if (data_.trajectory_data.count(trajectory_id) == 0) {
    data_.trajectory_data = optimization_problem_->trajectory_data();
  }
}

void PoseGraph2D::SetTrajectoryDataFromProto(
    const proto::TrajectoryData& data) {
  if (!data.has_fixed_frame_origin_in_map()) {
    return;
  }
  TrajectoryData trajectory_data;
  trajectory_data.fixed_frame_origin_in_map =
      transform::ToRigid3(data.fixed_frame_origin_in_map());
  const int trajectory_id = data.trajectory_id();
  AddChangeOf(trajectory_id, [this, trajectory_id, trajectory_data]() {
    mutex_.AssertHeld();
    optimization_problem_->SetTrajectoryData(trajectory_id, trajectory_data);
    data_.trajectory_data = optimization_problem_->trajectory_data();
  });
}

void PoseGraph2D::AddNodeToSubmap(const NodeId& node_id,
                                  const SubmapId& submap_id) {
  AddChangeOf(submap_id.trajectory_id, [this, node_id, submap_id]() {
    mutex_.AssertHeld();
    data_.submap_data.at(submap_id).node_ids.insert(node_id);
  });
}

void PoseGraph2D::AddSerializedConstraints(
    const std::vector<Constraint>& constraints) {
  AddChange([this, constraints]() {
    mutex_.AssertHeld();
    for (const Constraint& constraint : constraints) {
      AddSerializedConstraint(constraint);
    }
  });
}

void PoseGraph2D::AddSerializedConstraint(Constraint constraint) {
  const bool has_both_ends =
      data_.submap_data.Contains(constraint.submap_id) &&
      data_.trajectory_nodes.Contains(constraint.node_id);
  if (!has_both_ends) {
    LOG(ERROR) << "dropped a constraint between submap " << constraint.submap_id
               << " and node " << constraint.node_id
               << ", as one of them is missing";
    return;
  }
  if (constraint.tag == Constraint::INTER_SUBMAP) {
    UpdateTrajectoryConnectivity(constraint);
  } else {
    data_.submap_data.at(constraint.submap_id)
        .node_ids.insert(constraint.node_id);
  }
  // (submap <- tracking) in files, (submap <- gravity aligned) here.
  constraint.pose.zbar_ij = constraint.pose.zbar_ij *
                            transform::Rigid3d::Rotation(
                                GravityAlignment(constraint.node_id).inverse());
  data_.constraints.push_back(constraint);
}

}  // namespace mapping
}  // namespace cartographer
