// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/fixed_frame_pose_data.h"

#include "cartographer/transform/transform.h"

namespace cartographer {
namespace sensor {

proto::FixedFramePoseData ToProto(const FixedFramePoseData& pose_data) {
  proto::FixedFramePoseData proto;
  proto.set_timestamp(common::ToUniversal(pose_data.time));
  if (pose_data.pose.has_value()) {
    *proto.mutable_pose() = transform::ToProto(*pose_data.pose);
  }
  return proto;
}

FixedFramePoseData FromProto(const proto::FixedFramePoseData& proto) {
  FixedFramePoseData result;
  result.time = common::FromUniversal(proto.timestamp());
  if (proto.has_pose()) result.pose = transform::ToRigid3(proto.pose());
  return result;
}

}  // namespace sensor
}  // namespace cartographer
