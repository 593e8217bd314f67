// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/timed_point_cloud_data.h"

#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace sensor {

proto::TimedPointCloudData ToProto(
    const TimedPointCloudData& timed_point_cloud_data) {
  proto::TimedPointCloudData proto;
  proto.set_timestamp(common::ToUniversal(timed_point_cloud_data.time));
  *proto.mutable_origin() = transform::ToProto(timed_point_cloud_data.origin);
  for (const TimedRangefinderPoint& point : timed_point_cloud_data.ranges) {
    *proto.add_point_data() = ToProto(point);
  }
  for (const float intensity : timed_point_cloud_data.intensities) {
    proto.add_intensities(intensity);
  }
  return proto;
}

TimedPointCloudData FromProto(const proto::TimedPointCloudData& proto) {
  TimedPointCloudData result;
  result.time = common::FromUniversal(proto.timestamp());
  result.origin = transform::ToEigen(proto.origin());
  for (const auto& point : proto.point_data()) {
    result.ranges.push_back(FromProto(point));
  }
  // Older data has four-vectors whose last element is the time.
  if (proto.point_data().empty()) {
    for (const auto& legacy : proto.point_data_legacy()) {
      const Eigen::Vector4f point = transform::ToEigen(legacy);
      result.ranges.push_back({point.head<3>(), point[3]});
    }
  }
  result.intensities.assign(proto.intensities().begin(),
                            proto.intensities().end());
  CHECK(result.intensities.empty() ||
        result.intensities.size() == result.ranges.size());
  return result;
}

}  // namespace sensor
}  // namespace cartographer
