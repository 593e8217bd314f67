// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/trajectory_node.h"

#include "cartographer/sensor/compressed_point_cloud.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {
namespace {

using sensor::CompressedPointCloud;

}  // namespace

proto::TrajectoryNodeData ToProto(const TrajectoryNode::Data& constant_data) {
  proto::TrajectoryNodeData node;
  // Clouds without points are written too: readers expect the fields.
  const auto compress = [](const sensor::PointCloud& cloud) {
    return CompressedPointCloud(cloud).ToProto();
  };
  *node.mutable_low_resolution_point_cloud() =
      compress(constant_data.low_resolution_point_cloud);
  *node.mutable_high_resolution_point_cloud() =
      compress(constant_data.high_resolution_point_cloud);
  *node.mutable_filtered_gravity_aligned_point_cloud() =
      compress(constant_data.filtered_gravity_aligned_point_cloud);
  const Eigen::VectorXf& histogram =
      constant_data.rotational_scan_matcher_histogram;
  node.mutable_rotational_scan_matcher_histogram()->Add(
      histogram.data(), histogram.data() + histogram.size());
  *node.mutable_local_pose() = transform::ToProto(constant_data.local_pose);
  *node.mutable_gravity_alignment() =
      transform::ToProto(constant_data.gravity_alignment);
  node.set_timestamp(common::ToUniversal(constant_data.time));
  return node;
}

TrajectoryNode::Data FromProto(const proto::TrajectoryNodeData& proto) {
  TrajectoryNode::Data data;
  data.time = common::FromUniversal(proto.timestamp());
  data.gravity_alignment = transform::ToEigen(proto.gravity_alignment());
  data.filtered_gravity_aligned_point_cloud =
      CompressedPointCloud(proto.filtered_gravity_aligned_point_cloud())
          .Decompress();
  data.high_resolution_point_cloud =
      CompressedPointCloud(proto.high_resolution_point_cloud()).Decompress();
  data.low_resolution_point_cloud =
      CompressedPointCloud(proto.low_resolution_point_cloud()).Decompress();
  data.rotational_scan_matcher_histogram = Eigen::Map<const Eigen::VectorXf>(
      proto.rotational_scan_matcher_histogram().data(),
      proto.rotational_scan_matcher_histogram_size());
  data.local_pose = transform::ToRigid3(proto.local_pose());
  return data;
}

}  // namespace mapping
}  // namespace cartographer
