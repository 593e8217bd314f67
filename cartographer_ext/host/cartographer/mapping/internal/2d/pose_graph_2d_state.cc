// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of PoseGraph2D that takes in data other than new nodes, changes the
// state of trajectories, and answers questions.
#include <algorithm>
#include <iterator>
#include <utility>

#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d_metrics.h"
#include "cartographer/transform/timestamped_transform.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

using DeletionState = InternalTrajectoryState::DeletionState;

// The pose of a trajectory at `time`: interpolated, or that of the nearest end.
// `time_of` and `pose_of` read an entry of `nodes`, which must have some of the
// trajectory.
template <typename NodeType, typename TimeOf, typename PoseOf>
transform::Rigid3d PoseAt(const MapById<NodeId, NodeType>& nodes,
                          const int trajectory_id, const common::Time time,
                          const TimeOf& time_of, const PoseOf& pose_of) {
  const auto begin = nodes.BeginOfTrajectory(trajectory_id);
  const auto after = nodes.lower_bound(trajectory_id, time);
  if (after == begin) {
    return pose_of((*begin).data);
  }
  const NodeType& before = (*std::prev(after)).data;
  if (after == nodes.EndOfTrajectory(trajectory_id)) {
    return pose_of(before);
  }
  const NodeType& node_after = (*after).data;
  return transform::Interpolate(
             transform::TimestampedTransform{time_of(before), pose_of(before)},
             transform::TimestampedTransform{time_of(node_after),
                                             pose_of(node_after)},
             time)
      .transform;
}

}  // namespace

// Data beside the nodes.

void PoseGraph2D::AddChangeOf(const int trajectory_id,
                              const std::function<void()>& change) {
  AddWorkItem([this, trajectory_id, change]() {
    absl::MutexLock lock(&mutex_);
    if (CanModify(trajectory_id)) {
      change();
    } else {
      LOG_EVERY_N(WARNING, 100) << "trajectory " << trajectory_id
                                << " has come to its end, data is dropped";
    }
    return WorkItem::Result::kDoNotRunOptimization;
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
    for (const auto& observation : landmark_data.landmark_observations) {
      data_.landmark_nodes[observation.id].landmark_observations.push_back(
          LandmarkNode::LandmarkObservation{
              trajectory_id, landmark_data.time,
              observation.landmark_to_tracking_transform,
              observation.translation_weight, observation.rotation_weight});
    }
  });
}

void PoseGraph2D::SetLandmarkPose(const std::string& landmark_id,
                                  const transform::Rigid3d& global_pose,
                                  const bool frozen) {
  AddWorkItem([this, landmark_id, global_pose, frozen]() {
    absl::MutexLock lock(&mutex_);
    LandmarkNode& landmark = data_.landmark_nodes[landmark_id];
    landmark.global_landmark_pose = global_pose;
    landmark.frozen = frozen;
    return WorkItem::Result::kDoNotRunOptimization;
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
  // std::function wants to be copied.
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
  AddWorkItem([this, trajectory_id]() {
    absl::MutexLock lock(&mutex_);
    LOG_IF(WARNING, IsInState(trajectory_id, TrajectoryState::FINISHED))
        << "trajectory " << trajectory_id << " is finished already";
    data_.trajectories_state[trajectory_id].state = TrajectoryState::FINISHED;
    for (const auto& submap : data_.submap_data.trajectory(trajectory_id)) {
      data_.submap_data.at(submap.id).state = SubmapState::kFinished;
    }
    return WorkItem::Result::kRunOptimization;
  });
}

void PoseGraph2D::FreezeTrajectory(const int trajectory_id) {
  {
    absl::MutexLock lock(&mutex_);
    data_.trajectory_connectivity_state.Add(trajectory_id);
  }
  AddWorkItem([this, trajectory_id]() {
    absl::MutexLock lock(&mutex_);
    // What is frozen stays where it is, so frozen trajectories are connected,
    // but for long enough not to count as a recent connection.
    TrajectoryConnectivityState& connectivity =
        data_.trajectory_connectivity_state;
    for (const auto& id_state : data_.trajectories_state) {
      if (id_state.second.state == TrajectoryState::FROZEN &&
          !connectivity.TransitivelyConnected(trajectory_id, id_state.first)) {
        connectivity.Connect(trajectory_id, id_state.first,
                             common::FromUniversal(0));
      }
    }
    data_.trajectories_state[trajectory_id].state = TrajectoryState::FROZEN;
    return WorkItem::Result::kDoNotRunOptimization;
  });
}

void PoseGraph2D::DeleteTrajectory(const int trajectory_id) {
  {
    absl::MutexLock lock(&mutex_);
    const auto it = data_.trajectories_state.find(trajectory_id);
    if (it == data_.trajectories_state.end()) {
      LOG(WARNING) << "there is no trajectory " << trajectory_id
                   << " to delete";
      return;
    }
    it->second.deletion_state = DeletionState::SCHEDULED_FOR_DELETION;
  }
  AddWorkItem([this, trajectory_id]() {
    absl::MutexLock lock(&mutex_);
    InternalTrajectoryState& state = data_.trajectories_state.at(trajectory_id);
    if (state.state == TrajectoryState::ACTIVE ||
        state.state == TrajectoryState::DELETED) {
      LOG(ERROR) << "trajectory " << trajectory_id
                 << " cannot be deleted: it is neither finished nor frozen";
      state.deletion_state = DeletionState::NORMAL;
    } else {
      state.deletion_state = DeletionState::WAIT_FOR_DELETION;
    }
    return WorkItem::Result::kDoNotRunOptimization;
  });
}

bool PoseGraph2D::IsTrajectoryFinished(const int trajectory_id) const {
  absl::MutexLock lock(&mutex_);
  return IsInState(trajectory_id, TrajectoryState::FINISHED);
}

bool PoseGraph2D::IsTrajectoryFrozen(const int trajectory_id) const {
  absl::MutexLock lock(&mutex_);
  return IsInState(trajectory_id, TrajectoryState::FROZEN);
}

bool PoseGraph2D::IsInState(const int trajectory_id,
                            const TrajectoryState state) const {
  const auto it = data_.trajectories_state.find(trajectory_id);
  return it != data_.trajectories_state.end() && it->second.state == state;
}

// Stored states.

void PoseGraph2D::AddSubmapFromProto(
    const transform::Rigid3d& global_submap_pose, const proto::Submap& submap) {
  if (!submap.has_submap_2d()) {
    return;
  }
  const SubmapId submap_id{submap.submap_id().trajectory_id(),
                           submap.submap_id().submap_index()};
  const transform::Rigid2d pose = transform::Project2D(global_submap_pose);
  {
    absl::MutexLock lock(&mutex_);
    AddTrajectoryIfNeeded(submap_id.trajectory_id);
    InternalSubmapData submap_data;
    submap_data.submap = std::make_shared<const Submap2D>(submap.submap_2d(),
                                                          &conversion_tables_);
    data_.submap_data.Insert(submap_id, submap_data);
    // Visible at once, even before anything is optimised.
    data_.global_submap_poses_2d.Insert(submap_id,
                                        optimization::SubmapSpec2D{pose});
  }
  AddWorkItem([this, submap_id, pose]() {
    absl::MutexLock lock(&mutex_);
    data_.submap_data.at(submap_id).state = SubmapState::kFinished;
    optimization_problem_->InsertSubmap(submap_id, pose);
    PoseGraph2DMetrics& metrics = GetPoseGraph2DMetrics();
    const bool is_frozen =
        IsInState(submap_id.trajectory_id, TrajectoryState::FROZEN);
    (is_frozen ? metrics.frozen_submaps : metrics.active_submaps)->Increment();
    return WorkItem::Result::kDoNotRunOptimization;
  });
}

void PoseGraph2D::AddNodeFromProto(const transform::Rigid3d& global_pose,
                                   const proto::Node& node) {
  const NodeId node_id{node.node_id().trajectory_id(),
                       node.node_id().node_index()};
  const auto data =
      std::make_shared<const TrajectoryNode::Data>(FromProto(node.node_data()));
  {
    absl::MutexLock lock(&mutex_);
    AddTrajectoryIfNeeded(node_id.trajectory_id);
    data_.trajectory_nodes.Insert(node_id, TrajectoryNode{data, global_pose});
  }
  AddWorkItem([this, node_id, data, global_pose]() {
    const auto upright =
        transform::Rigid3d::Rotation(data->gravity_alignment.inverse());
    absl::MutexLock lock(&mutex_);
    optimization_problem_->InsertTrajectoryNode(
        node_id,
        optimization::NodeSpec2D{
            data->time, transform::Project2D(data->local_pose * upright),
            transform::Project2D(global_pose * upright),
            data->gravity_alignment});
    if (data_.trajectory_data.count(node_id.trajectory_id) == 0) {
      data_.trajectory_data = optimization_problem_->trajectory_data();
    }
    return WorkItem::Result::kDoNotRunOptimization;
  });
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
  AddWorkItem([this, constraints]() {
    absl::MutexLock lock(&mutex_);
    for (Constraint constraint : constraints) {
      if (!data_.submap_data.Contains(constraint.submap_id) ||
          !data_.trajectory_nodes.Contains(constraint.node_id)) {
        LOG(ERROR) << "dropped a constraint between submap "
                   << constraint.submap_id << " and node " << constraint.node_id
                   << ", which are not both there";
        continue;
      }
      if (constraint.tag == Constraint::INTRA_SUBMAP) {
        data_.submap_data.at(constraint.submap_id)
            .node_ids.insert(constraint.node_id);
      } else {
        UpdateTrajectoryConnectivity(constraint);
      }
      // Stored is (submap <- tracking).
      const Eigen::Quaterniond& gravity_alignment =
          data_.trajectory_nodes.at(constraint.node_id)
              .constant_data->gravity_alignment;
      constraint.pose.zbar_ij =
          constraint.pose.zbar_ij *
          transform::Rigid3d::Rotation(gravity_alignment.inverse());
      data_.constraints.push_back(constraint);
    }
    return WorkItem::Result::kDoNotRunOptimization;
  });
}

// Questions.

common::Time PoseGraph2D::GetLatestNodeTime(const NodeId& node_id,
                                            const SubmapId& submap_id) const {
  const common::Time time = data_.trajectory_nodes.at(node_id).time();
  const std::set<NodeId>& node_ids = data_.submap_data.at(submap_id).node_ids;
  return node_ids.empty()
             ? time
             : std::max(time,
                        data_.trajectory_nodes.at(*node_ids.rbegin()).time());
}

void PoseGraph2D::UpdateTrajectoryConnectivity(const Constraint& constraint) {
  data_.trajectory_connectivity_state.Connect(
      constraint.node_id.trajectory_id, constraint.submap_id.trajectory_id,
      GetLatestNodeTime(constraint.node_id, constraint.submap_id));
}

transform::Rigid3d PoseGraph2D::LocalToGlobal(const int trajectory_id) const {
  const auto& poses = data_.global_submap_poses_2d;
  if (poses.SizeOfTrajectoryOrZero(trajectory_id) > 0) {
    const auto last = *std::prev(poses.EndOfTrajectory(trajectory_id));
    return transform::Embed3D(last.data.global_pose) *
           data_.submap_data.at(last.id).submap->local_pose().inverse();
  }
  const auto initial = data_.initial_trajectory_poses.find(trajectory_id);
  if (initial == data_.initial_trajectory_poses.end() ||
      data_.trajectory_nodes.SizeOfTrajectoryOrZero(
          initial->second.to_trajectory_id) == 0) {
    return transform::Rigid3d::Identity();
  }
  return PoseAt(
             data_.trajectory_nodes, initial->second.to_trajectory_id,
             initial->second.time,
             [](const TrajectoryNode& node) { return node.time(); },
             [](const TrajectoryNode& node) { return node.global_pose; }) *
         initial->second.relative_pose;
}

transform::Rigid3d PoseGraph2D::InitialLocalToGlobal(
    const int trajectory_id) const {
  using optimization::NodeSpec2D;
  const auto initial = data_.initial_trajectory_poses.find(trajectory_id);
  if (initial == data_.initial_trajectory_poses.end()) {
    return transform::Rigid3d::Identity();
  }
  const int other = initial->second.to_trajectory_id;
  const auto& nodes = optimization_problem_->node_data();
  if (nodes.SizeOfTrajectoryOrZero(other) == 0) {
    LOG(ERROR) << "trajectory " << trajectory_id << " should begin relative to "
               << other << ", which has no nodes";
    return transform::Rigid3d::Identity();
  }
  return PoseAt(
             nodes, other, initial->second.time,
             [](const NodeSpec2D& node) { return node.time; },
             [](const NodeSpec2D& node) {
               return transform::Embed3D(node.global_pose_2d) *
                      transform::Rigid3d::Rotation(node.gravity_alignment);
             }) *
         initial->second.relative_pose;
}

transform::Rigid3d PoseGraph2D::GetInterpolatedGlobalTrajectoryPose(
    const int trajectory_id, const common::Time time) const {
  absl::MutexLock lock(&mutex_);
  CHECK_GT(data_.trajectory_nodes.SizeOfTrajectoryOrZero(trajectory_id), 0);
  return PoseAt(
      data_.trajectory_nodes, trajectory_id, time,
      [](const TrajectoryNode& node) { return node.time(); },
      [](const TrajectoryNode& node) { return node.global_pose; });
}

PoseGraphInterface::SubmapData PoseGraph2D::SubmapDataUnderLock(
    const SubmapId& submap_id) const {
  if (!data_.submap_data.Contains(submap_id)) {
    return {};
  }
  const auto& submap = data_.submap_data.at(submap_id).submap;
  const auto& poses = data_.global_submap_poses_2d;
  return SubmapData{
      submap,
      poses.Contains(submap_id)
          ? transform::Embed3D(poses.at(submap_id).global_pose)
          : LocalToGlobal(submap_id.trajectory_id) * submap->local_pose()};
}

PoseGraphInterface::SubmapData PoseGraph2D::GetSubmapData(
    const SubmapId& submap_id) const {
  absl::MutexLock lock(&mutex_);
  return SubmapDataUnderLock(submap_id);
}

MapById<SubmapId, PoseGraphInterface::SubmapData>
PoseGraph2D::GetAllSubmapData() const {
  MapById<SubmapId, PoseGraphInterface::SubmapData> result;
  absl::MutexLock lock(&mutex_);
  for (const auto& submap : data_.submap_data) {
    result.Insert(submap.id, SubmapDataUnderLock(submap.id));
  }
  return result;
}

MapById<SubmapId, PoseGraphInterface::SubmapPose>
PoseGraph2D::GetAllSubmapPoses() const {
  MapById<SubmapId, SubmapPose> result;
  absl::MutexLock lock(&mutex_);
  for (const auto& submap : data_.submap_data) {
    result.Insert(submap.id, SubmapPose{submap.data.submap->num_range_data(),
                                        SubmapDataUnderLock(submap.id).pose});
  }
  return result;
}

transform::Rigid3d PoseGraph2D::GetLocalToGlobalTransform(
    const int trajectory_id) const {
  absl::MutexLock lock(&mutex_);
  return LocalToGlobal(trajectory_id);
}

MapById<NodeId, TrajectoryNode> PoseGraph2D::GetTrajectoryNodes() const {
  absl::MutexLock lock(&mutex_);
  return data_.trajectory_nodes;
}

MapById<NodeId, TrajectoryNodePose> PoseGraph2D::GetTrajectoryNodePoses()
    const {
  MapById<NodeId, TrajectoryNodePose> result;
  absl::MutexLock lock(&mutex_);
  for (const auto& node : data_.trajectory_nodes) {
    result.Insert(node.id,
                  TrajectoryNodePose{node.data.global_pose,
                                     TrajectoryNodePose::ConstantPoseData{
                                         node.data.time(),
                                         node.data.constant_data->local_pose}});
  }
  return result;
}

std::map<int, PoseGraphInterface::TrajectoryState>
PoseGraph2D::GetTrajectoryStates() const {
  std::map<int, TrajectoryState> result;
  absl::MutexLock lock(&mutex_);
  for (const auto& id_state : data_.trajectories_state) {
    result[id_state.first] = id_state.second.state;
  }
  return result;
}

std::map<std::string, transform::Rigid3d> PoseGraph2D::GetLandmarkPoses()
    const {
  std::map<std::string, transform::Rigid3d> result;
  absl::MutexLock lock(&mutex_);
  for (const auto& id_landmark : data_.landmark_nodes) {
    if (id_landmark.second.global_landmark_pose.has_value()) {
      result[id_landmark.first] = *id_landmark.second.global_landmark_pose;
    }
  }
  return result;
}

std::map<std::string, PoseGraphInterface::LandmarkNode>
PoseGraph2D::GetLandmarkNodes() const {
  absl::MutexLock lock(&mutex_);
  return data_.landmark_nodes;
}

std::map<int, PoseGraphInterface::TrajectoryData>
PoseGraph2D::GetTrajectoryData() const {
  absl::MutexLock lock(&mutex_);
  return data_.trajectory_data;
}

sensor::MapByTime<sensor::ImuData> PoseGraph2D::GetImuData() const {
  absl::MutexLock lock(&mutex_);
  return optimization_problem_->imu_data();
}

sensor::MapByTime<sensor::OdometryData> PoseGraph2D::GetOdometryData() const {
  absl::MutexLock lock(&mutex_);
  return optimization_problem_->odometry_data();
}

sensor::MapByTime<sensor::FixedFramePoseData>
PoseGraph2D::GetFixedFramePoseData() const {
  absl::MutexLock lock(&mutex_);
  return optimization_problem_->fixed_frame_pose_data();
}

std::vector<std::vector<int>> PoseGraph2D::GetConnectedTrajectories() const {
  absl::MutexLock lock(&mutex_);
  return data_.trajectory_connectivity_state.Components();
}

std::vector<PoseGraphInterface::Constraint> PoseGraph2D::constraints() const {
  absl::MutexLock lock(&mutex_);
  std::vector<Constraint> result = data_.constraints;
  for (Constraint& constraint : result) {
    // Seen from outside, constraints are about the tracking frame.
    constraint.pose.zbar_ij = constraint.pose.zbar_ij *
                              transform::Rigid3d::Rotation(
                                  data_.trajectory_nodes.at(constraint.node_id)
                                      .constant_data->gravity_alignment);
  }
  return result;
}

}  // namespace mapping
}  // namespace cartographer
