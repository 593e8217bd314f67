// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/point_cloud.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace cartographer {
namespace sensor {
namespace {

template <typename Point>
std::vector<Point> Transformed(const std::vector<Point>& points,
                               const transform::Rigid3f& transform) {
  std::vector<Point> result;
  result.reserve(points.size());
  std::transform(
      points.begin(), points.end(), std::back_inserter(result),
      [&transform](const Point& point) { return transform * point; });
  return result;
}

}  // namespace

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
  return PointCloud(Transformed(point_cloud.points(), transform),
                    point_cloud.intensities());
}

TimedPointCloud TransformTimedPointCloud(const TimedPointCloud& point_cloud,
                                         const transform::Rigid3f& transform) {
  return Transformed(point_cloud, transform);
}

PointCloud CropPointCloud(const PointCloud& point_cloud, const float min_z,
                          const float max_z) {
  // NaN counts as outside.
  const auto is_inside = [=](const RangefinderPoint& point) {
    const float z = point.position.z();
    return z >= min_z && z <= max_z;
  };
  return point_cloud.copy_if(is_inside);
}

}  // namespace sensor
}  // namespace cartographer
