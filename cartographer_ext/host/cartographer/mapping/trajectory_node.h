// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A node of the pose graph: what local SLAM knew when it inserted a scan, and
// where global SLAM believes it was.
#ifndef CARTOGRAPHER_MAPPING_TRAJECTORY_NODE_H_
#define CARTOGRAPHER_MAPPING_TRAJECTORY_NODE_H_

#include <memory>
#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "absl/types/optional.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/proto/trajectory_node_data.pb.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

// The poses of a node without its point clouds.
struct TrajectoryNodePose {
  struct ConstantPoseData {
    common::Time time;
    transform::Rigid3d local_pose;  // (local <- tracking)
  };
  transform::Rigid3d global_pose;  // (global <- tracking)
  absl::optional<ConstantPoseData> constant_pose_data;
};

struct TrajectoryNode {
  struct Data {
    common::Time time;
    // (gravity aligned <- tracking)
    Eigen::Quaterniond gravity_alignment;
    // Filtered returns in the gravity-aligned frame, metres; what 2D loop
    // closure matches.
    sensor::PointCloud filtered_gravity_aligned_point_cloud;
    // The next three are empty in 2D.
    sensor::PointCloud high_resolution_point_cloud;
    sensor::PointCloud low_resolution_point_cloud;
    Eigen::VectorXf rotational_scan_matcher_histogram;
    transform::Rigid3d local_pose;  // (local <- tracking)
  };

  common::Time time() const { return constant_data->time; }

  // Shared, so that readers may keep it while the node is trimmed.
  std::shared_ptr<const Data> constant_data;
  transform::Rigid3d global_pose;  // (global <- tracking)
};

proto::TrajectoryNodeData ToProto(const TrajectoryNode::Data& constant_data);
TrajectoryNode::Data FromProto(const proto::TrajectoryNodeData& proto);

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_TRAJECTORY_NODE_H_
