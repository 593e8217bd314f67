// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/transform/timestamped_transform.h"

#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace transform {

TimestampedTransform FromProto(const proto::TimestampedTransform& proto) {
  return {common::FromUniversal(proto.time()), ToRigid3(proto.transform())};
}

proto::TimestampedTransform ToProto(const TimestampedTransform& transform) {
  proto::TimestampedTransform proto;
  proto.set_time(common::ToUniversal(transform.time));
  *proto.mutable_transform() = ToProto(transform.transform);
  return proto;
}

TimestampedTransform Interpolate(const TimestampedTransform& start,
                                 const TimestampedTransform& end,
                                 const common::Time time) {
  CHECK_LE(start.time, time);
  CHECK_LE(time, end.time);
  if (start.time == end.time) return {time, start.transform};
  const double ratio = common::ToSeconds(time - start.time) /
                       common::ToSeconds(end.time - start.time);
  const Eigen::Vector3d& from = start.transform.translation();
  const Eigen::Vector3d& to = end.transform.translation();
  return {time, Rigid3d(from + (to - from) * ratio,
                        start.transform.rotation().slerp(
                            ratio, end.transform.rotation()))};
}

}  // namespace transform
}  // namespace cartographer
