// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_POINT_CLOUD_H_
#define CARTOGRAPHER_SENSOR_POINT_CLOUD_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer/sensor/proto/sensor.pb.h"
#include "cartographer/sensor/rangefinder_point.h"
#include "cartographer/transform/rigid_transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace sensor {

// Points in some frame, optionally with one intensity each.
class PointCloud {
 public:
  using PointType = RangefinderPoint;
  using ConstIterator = std::vector<PointType>::const_iterator;

  PointCloud();
  explicit PointCloud(std::vector<PointType> points);
  // As many intensities as points, or none.
  PointCloud(std::vector<PointType> points, std::vector<float> intensities);

  size_t size() const { return points_.size(); }
  bool empty() const { return points_.empty(); }
  const std::vector<PointType>& points() const { return points_; }
  const std::vector<float>& intensities() const { return intensities_; }
  const PointType& operator[](const size_t index) const {
    return points_[index];
  }
  ConstIterator begin() const { return points_.begin(); }
  ConstIterator end() const { return points_.end(); }

  // Fatal when there are intensities.
  void push_back(PointType value);

  // The points that `predicate` holds for, with their intensities.
  template <class UnaryPredicate>
  PointCloud copy_if(UnaryPredicate predicate) const {
    PointCloud result;
    for (size_t i = 0; i != points_.size(); ++i) {
      if (!predicate(points_[i])) continue;
      result.points_.push_back(points_[i]);
      if (!intensities_.empty()) {
        result.intensities_.push_back(intensities_[i]);
      }
    }
    return result;
  }

 private:
  std::vector<PointType> points_;
  std::vector<float> intensities_;
};

using TimedPointCloud = std::vector<TimedRangefinderPoint>;

struct PointCloudWithIntensities {
  TimedPointCloud points;
  std::vector<float> intensities;
};

PointCloud TransformPointCloud(const PointCloud& point_cloud,
                               const transform::Rigid3f& transform);

TimedPointCloud TransformTimedPointCloud(const TimedPointCloud& point_cloud,
                                         const transform::Rigid3f& transform);

// Points with min_z <= z <= max_z.
PointCloud CropPointCloud(const PointCloud& point_cloud, float min_z,
                          float max_z);

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_POINT_CLOUD_H_
