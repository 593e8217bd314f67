// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/range_data.h"

#include <utility>
#include <vector>

#include "cartographer/transform/transform.h"

namespace cartographer {
namespace sensor {

namespace {

// Older data has plain vectors in place of points.
template <typename Points, typename LegacyPoints>
PointCloud PointsFromProto(const Points& points, const LegacyPoints& legacy) {
  std::vector<RangefinderPoint> result;
  if (points.empty()) {
    result.reserve(legacy.size());
    for (const auto& point : legacy)
      result.push_back({transform::ToEigen(point)});
  } else {
    result.reserve(points.size());
    for (const auto& point : points) result.push_back(FromProto(point));
  }
  return PointCloud(std::move(result));
}

}  // namespace

RangeData TransformRangeData(const RangeData& range_data,
                             const transform::Rigid3f& transform) {
  return {transform * range_data.origin,
          TransformPointCloud(range_data.returns, transform),
          TransformPointCloud(range_data.misses, transform)};
}

RangeData CropRangeData(const RangeData& range_data, const float min_z,
                        const float max_z) {
  return {range_data.origin, CropPointCloud(range_data.returns, min_z, max_z),
          CropPointCloud(range_data.misses, min_z, max_z)};
}

proto::RangeData ToProto(const RangeData& range_data) {
  proto::RangeData proto;
  *proto.mutable_origin() = transform::ToProto(range_data.origin);
  for (const RangefinderPoint& point : range_data.returns) {
    *proto.add_returns() = ToProto(point);
  }
  for (const RangefinderPoint& point : range_data.misses) {
    *proto.add_misses() = ToProto(point);
  }
  return proto;
}

RangeData FromProto(const proto::RangeData& proto) {
  return {transform::ToEigen(proto.origin()),
          PointsFromProto(proto.returns(), proto.returns_legacy()),
          PointsFromProto(proto.misses(), proto.misses_legacy())};
}

}  // namespace sensor
}  // namespace cartographer
