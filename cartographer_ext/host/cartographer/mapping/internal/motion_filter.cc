// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/motion_filter.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace mapping {

proto::MotionFilterOptions CreateMotionFilterOptions(
    common::LuaParameterDictionary* const table) {
  return common::ReadOptions<proto::MotionFilterOptions>(table);
}

MotionFilter::MotionFilter(const proto::MotionFilterOptions& options)
    : options_(options) {}

bool MotionFilter::IsSimilar(const common::Time time,
                             const transform::Rigid3d& pose) {
  if (has_last_) {
    const bool recent =
        time - last_time_ <= common::FromSeconds(options_.max_time_seconds());
    const double distance =
        (pose.translation() - last_pose_.translation()).norm();
    if (recent && distance <= options_.max_distance_meters() &&
        transform::GetAngle(pose.inverse() * last_pose_) <=
            options_.max_angle_radians()) {
      return true;
    }
  }
  has_last_ = true;
  last_time_ = time;
  last_pose_ = pose;
  return false;
}

}  // namespace mapping
}  // namespace cartographer
