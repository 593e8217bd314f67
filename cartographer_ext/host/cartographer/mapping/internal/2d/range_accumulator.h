// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Unwarps sweeps by the motion of the robot and collects a number of them into
// the range data of one scan match.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_RANGE_ACCUMULATOR_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_RANGE_ACCUMULATOR_H_

#include <vector>

#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

class RangeAccumulator {
 public:
  explicit RangeAccumulator(
      const proto::LocalTrajectoryBuilderOptions2D& options)
      : options_(options) {}

  // `poses` are (local <- tracking) at the time of every point. Ranges up to
  // max_range count as returns. Of longer ones only the first
  // missing_data_ray_length metres are known to be free. Ranges below min_range
  // and those that are not a number are dropped.
  void Add(const sensor::TimedPointCloudOriginData& sweep,
           const std::vector<transform::Rigid3f>& poses);

  // Whether num_accumulated_range_data sweeps were added.
  bool IsComplete() const {
    return num_sweeps_ >= options_.num_accumulated_range_data();
  }

  // What was added since the last call, in the gravity-aligned frame of the
  // newest pose: cropped to [min_z, max_z], then one point per voxel.
  sensor::RangeData Take(const transform::Rigid3f& newest_pose,
                         const transform::Rigid3f& gravity_alignment);

 private:
  void AddRay(const Eigen::Vector3f& origin, sensor::RangefinderPoint hit);

  const proto::LocalTrajectoryBuilderOptions2D options_;
  int num_sweeps_ = 0;
  // In the local frame.
  sensor::PointCloud returns_;
  sensor::PointCloud misses_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_RANGE_ACCUMULATOR_H_
