// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Trajectory nodes as the optimisation problem wants them: in the plane, that
// is, of the gravity-aligned frame.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_NODE_SPEC_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_NODE_SPEC_H_

#include "cartographer/mapping/internal/optimization/optimization_problem_2d.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {

// (frame <- gravity aligned) of a node, given (frame <- tracking).
inline transform::Rigid2d GravityAlignedPose2D(
    const transform::Rigid3d& pose, const TrajectoryNode::Data& node) {
  const auto tracking_from_gravity_aligned =
      transform::Rigid3d::Rotation(node.gravity_alignment.inverse());
  return transform::Project2D(pose * tracking_from_gravity_aligned);
}

inline transform::Rigid2d LocalPose2D(const TrajectoryNode::Data& node) {
  return GravityAlignedPose2D(node.local_pose, node);
}

inline optimization::NodeSpec2D MakeNodeSpec(
    const TrajectoryNode::Data& node, const transform::Rigid2d& global_pose) {
  return optimization::NodeSpec2D{node.time, LocalPose2D(node), global_pose,
                                  node.gravity_alignment};
}

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_NODE_SPEC_H_
