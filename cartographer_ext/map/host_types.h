// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Conversion between the host's types and those of the metrics.
#ifndef CARTOGRAPHER_EXT_MAP_HOST_TYPES_H_
#define CARTOGRAPHER_EXT_MAP_HOST_TYPES_H_

#include <cstdint>

#include "Eigen/Geometry"
#include "cartographer/common/time.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/host_ticks.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace evaluation {

// The host counts ticks of 100 ns since the year 1. Stamps relative to the
// start of a log are treated as times since 1970.
inline cartographer::common::Time ToHostTime(const io::TimeNs time) {
  // Rounds to the nearest tick, also below zero.
  const io::TimeNs ticks = (time + (time >= 0 ? 50 : -50)) / 100;
  return cartographer::common::FromUniversal(ticks + kUnixEpochTicks);
}

// Of AreHostTicks, as all are that readers of files let pass. Clocks that began
// in the year 1 are relative, too, to whatever they began with.
inline io::TimeNs FromHostTicks(const int64_t universal_ticks) {
  return (universal_ticks <= kEraTicks ? universal_ticks
                                       : universal_ticks - kUnixEpochTicks) *
         100;
}

inline io::TimeNs FromHostTime(const cartographer::common::Time time) {
  return FromHostTicks(cartographer::common::ToUniversal(time));
}

inline Eigen::Isometry3d FromHostPose(
    const cartographer::transform::Rigid3d& pose) {
  return Eigen::Translation3d(pose.translation()) * pose.rotation();
}

inline cartographer::transform::Rigid3d ToHostPose(const Pose2& pose) {
  return cartographer::transform::Embed3D(ToRigid2d(pose));
}

// x, y and yaw of a spatial pose.
inline Pose2 ToPlanarPose(const cartographer::transform::Rigid3d& pose) {
  return cartographer_ext::ToPose2(pose);
}

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_HOST_TYPES_H_
