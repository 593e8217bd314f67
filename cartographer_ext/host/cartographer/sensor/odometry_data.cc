// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/odometry_data.h"

#include "cartographer/transform/transform.h"

namespace cartographer {
namespace sensor {

proto::OdometryData ToProto(const OdometryData& odometry_data) {
  proto::OdometryData proto;
  proto.set_timestamp(common::ToUniversal(odometry_data.time));
  *proto.mutable_pose() = transform::ToProto(odometry_data.pose);
  return proto;
}

OdometryData FromProto(const proto::OdometryData& proto) {
  return {common::FromUniversal(proto.timestamp()),
          transform::ToRigid3(proto.pose())};
}

}  // namespace sensor
}  // namespace cartographer
