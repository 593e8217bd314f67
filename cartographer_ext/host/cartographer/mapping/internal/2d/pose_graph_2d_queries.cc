// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of PoseGraph2D that answers queries.
#include <algorithm>
#include <iterator>

#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/transform/timestamped_transform.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

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

Eigen::Quaterniond PoseGraph2D::GravityAlignment(const NodeId& node_id) const {
  return data_.trajectory_nodes.at(node_id).constant_data->gravity_alignment;
}

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
  absl::MutexLock lock(&mutex_);
  return data_.trajectory_states.all();
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
    // (submap <- tracking) outside of the graph.
    constraint.pose.zbar_ij =
        constraint.pose.zbar_ij *
        transform::Rigid3d::Rotation(GravityAlignment(constraint.node_id));
  }
  return result;
}

}  // namespace mapping
}  // namespace cartographer
