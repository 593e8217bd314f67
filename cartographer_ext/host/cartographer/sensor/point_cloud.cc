// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/point_cloud.h"

#include <utility>

namespace cartographer {
namespace sensor {

PointCloud::PointCloud() {}

PointCloud::PointCloud(std::vector<PointType> points)
    : points_(std::move(points)) {}

PointCloud::PointCloud(std::vector<PointType> points,
                       std::vector<float> intensities)
    : points_(std::move(points)), intensities_(std::move(intensities)) {
  CHECK(intensities_.empty() || intensities_.size() == points_.size())
      << intensities_.size() << " intensities for " << points_.size()
      << " points";
}

void PointCloud::push_back(PointType value) {
  CHECK(intensities_.empty()) << "a point without intensity";
  points_.push_back(std::move(value));
}

PointCloud TransformPointCloud(const PointCloud& point_cloud,
                               const transform::Rigid3f& transform) {
  std::vector<RangefinderPoint> points;
  points.reserve(point_cloud.size());
  for (const RangefinderPoint& point : point_cloud) {
    points.push_back(transform * point);
  }
  return PointCloud(std::move(points), point_cloud.intensities());
}

TimedPointCloud TransformTimedPointCloud(const TimedPointCloud& point_cloud,
                                         const transform::Rigid3f& transform) {
  TimedPointCloud result;
  result.reserve(point_cloud.size());
  for (const TimedRangefinderPoint& point : point_cloud) {
    result.push_back(transform * point);
  }
  return result;
}

PointCloud CropPointCloud(const PointCloud& point_cloud, const float min_z,
                          const float max_z) {
  return point_cloud.copy_if([min_z, max_z](const RangefinderPoint& point) {
    return min_z <= point.position.z() && point.position.z() <= max_z;
  });
}

}  // namespace sensor
}  // namespace cartographer
