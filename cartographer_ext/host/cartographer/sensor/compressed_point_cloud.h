// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_COMPRESSED_POINT_CLOUD_H_
#define CARTOGRAPHER_SENSOR_COMPRESSED_POINT_CLOUD_H_

#include <iterator>
#include <vector>

#include "Eigen/Core"
#include "cartographer/common/port.h"
#include "cartographer/sensor/point_cloud.h"
#include "cartographer/sensor/proto/sensor.pb.h"

namespace cartographer {
namespace sensor {

// Points rounded to millimetres, ten bits a coordinate, grouped by cube of
// 1024 mm. The data is a sequence of
//   count, cube x, cube y, cube z, point_1 .. point_count
// with point = z << 20 | y << 10 | x in millimetres inside the cube. Keeps no
// intensities and, beyond one cube, not the order of points. Coordinates must
// be below 2^23 mm in size, which a CHECK enforces.
class CompressedPointCloud {
 public:
  class ConstIterator;

  CompressedPointCloud() = default;
  explicit CompressedPointCloud(const PointCloud& point_cloud);
  // Data that does not decode to `num_points` points is fatal.
  explicit CompressedPointCloud(const proto::CompressedPointCloud& proto);

  PointCloud Decompress() const;

  bool empty() const { return num_points_ == 0; }
  size_t size() const { return num_points_; }
  ConstIterator begin() const;
  ConstIterator end() const;

  bool operator==(const CompressedPointCloud& other) const;
  proto::CompressedPointCloud ToProto() const;

 private:
  std::vector<int32> point_data_;
  size_t num_points_ = 0;
};

class CompressedPointCloud::ConstIterator {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = RangefinderPoint;
  using difference_type = int64;
  using pointer = const RangefinderPoint*;
  using reference = const RangefinderPoint&;

  // Before the first point of `cloud`.
  explicit ConstIterator(const CompressedPointCloud* cloud);
  static ConstIterator EndIterator(const CompressedPointCloud* cloud);

  RangefinderPoint operator*() const;
  ConstIterator& operator++();
  bool operator==(const ConstIterator& other) const;
  bool operator!=(const ConstIterator& other) const;

 private:
  ConstIterator(const CompressedPointCloud* cloud, size_t position);
  // Steps over the header of a block when at one.
  void EnterBlock();

  const CompressedPointCloud* cloud_;
  size_t position_;          // of the point in the data
  int32 left_in_block_ = 0;  // this point included
  Eigen::Vector3i cube_ = Eigen::Vector3i::Zero();
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_COMPRESSED_POINT_CLOUD_H_
