// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Conversion of the host's ids, poses and nodes. A node of the host is the
// gravity-aligned frame, which does not rotate with the robot.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_NODE_GEOMETRY_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_NODE_GEOMETRY_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/mapping/id.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/uncertainty/ids.h"

namespace cartographer_ext {
namespace loop_closure {

// The host's id as ours.
inline uncertainty::NodeId ToKey(const cartographer::mapping::NodeId& id) {
  return uncertainty::NodeId{id.trajectory_id, id.node_index};
}

// The host's id as ours.
inline uncertainty::SubmapId ToKey(const cartographer::mapping::SubmapId& id) {
  return uncertainty::SubmapId{id.trajectory_id, id.submap_index};
}

// (local <- tracking frame)
inline Pose2 LocalPose(
    const cartographer::mapping::TrajectoryNode::Data& node) {
  return ToPose2(node.local_pose);
}

// (gravity-aligned frame <- tracking frame), a rotation.
inline Pose2 AlignedFromTracking(
    const cartographer::mapping::TrajectoryNode::Data& node) {
  const Pose2 aligned =
      ToPose2(node.local_pose * cartographer::transform::Rigid3d::Rotation(
                                    node.gravity_alignment.inverse()));
  return Pose2(0., 0., NormalizeAngle(LocalPose(node).theta - aligned.theta));
}

// Points of the cloud in the tracking frame.
inline std::vector<Eigen::Vector2f> PlanarPoints(
    const cartographer::mapping::TrajectoryNode::Data& node) {
  const Pose2 tracking_from_aligned = AlignedFromTracking(node).Inverse();
  std::vector<Eigen::Vector2f> points;
  points.reserve(node.filtered_gravity_aligned_point_cloud.size());
  for (const auto& point : node.filtered_gravity_aligned_point_cloud) {
    const Eigen::Vector2d aligned = point.position.head<2>().cast<double>();
    points.push_back((tracking_from_aligned * aligned).cast<float>());
  }
  return points;
}

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DROPIN_NODE_GEOMETRY_H_
