// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/range_accumulator.h"

#include <utility>

#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/sensor/point_cloud.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

void RangeAccumulator::Add(const sensor::TimedPointCloudOriginData& sweep,
                           const std::vector<transform::Rigid3f>& poses) {
  CHECK_EQ(sweep.ranges.size(), poses.size());
  auto pose = poses.begin();
  for (const auto& measurement : sweep.ranges) {
    AddRay(*pose * sweep.origins.at(measurement.origin_index),
           *pose * sensor::ToRangefinderPoint(measurement.point_time));
    ++pose;
  }
  ++num_sweeps_;
}

void RangeAccumulator::AddRay(const Eigen::Vector3f& origin,
                              sensor::RangefinderPoint hit) {
  const Eigen::Vector3f ray = hit.position - origin;
  const float range = ray.norm();
  if (range > options_.max_range()) {
    hit.position = origin + options_.missing_data_ray_length() / range * ray;
  }
  if (range >= options_.min_range()) {
    (range > options_.max_range() ? misses_ : returns_).push_back(hit);
  }
}

sensor::RangeData RangeAccumulator::Take(
    const transform::Rigid3f& newest_pose,
    const transform::Rigid3f& gravity_alignment) {
  const transform::Rigid3f gravity_aligned_from_local =
      gravity_alignment * newest_pose.inverse();
  const auto thin_out =
      [this, &gravity_aligned_from_local](sensor::PointCloud* const points) {
        const sensor::PointCloud cropped = sensor::CropPointCloud(
            sensor::TransformPointCloud(*points, gravity_aligned_from_local),
            options_.min_z(), options_.max_z());
        *points = sensor::PointCloud();
        return sensor::VoxelFilter(cropped, options_.voxel_filter_size());
      };
  num_sweeps_ = 0;
  sensor::RangeData result;
  result.origin = gravity_aligned_from_local * newest_pose.translation();
  result.returns = thin_out(&returns_);
  result.misses = thin_out(&misses_);
  return result;
}

}  // namespace mapping
}  // namespace cartographer
