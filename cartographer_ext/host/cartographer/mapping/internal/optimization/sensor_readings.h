// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Readings of odometry and of fixed frames, in the order of their stamps.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_SENSOR_READINGS_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_SENSOR_READINGS_H_

#include <iterator>

#include "absl/types/optional.h"
#include "cartographer/common/time.h"
#include "cartographer/sensor/fixed_frame_pose_data.h"
#include "cartographer/sensor/map_by_time.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/transform/rigid_transform.h"
#include "cartographer/transform/timestamped_transform.h"

namespace cartographer {
namespace mapping {
namespace optimization {

// The poses of fixed frame data may be missing, those of odometry never are.
inline absl::optional<transform::Rigid3d> PoseOf(
    const sensor::OdometryData& data) {
  return data.pose;
}
inline absl::optional<transform::Rigid3d> PoseOf(
    const sensor::FixedFramePoseData& data) {
  return data.pose;
}

// The pose at `time` between the readings before and after it. Nothing outside
// of the readings, or beside one without a pose.
template <typename DataType>
absl::optional<transform::Rigid3d> PoseAt(
    const sensor::MapByTime<DataType>& readings, const int trajectory_id,
    const common::Time time) {
  if (!readings.HasTrajectory(trajectory_id)) {
    return absl::nullopt;
  }
  const auto after = readings.lower_bound(trajectory_id, time);
  if (after == readings.EndOfTrajectory(trajectory_id)) {
    return absl::nullopt;
  }
  const auto pose_after = PoseOf(*after);
  if (!pose_after.has_value()) {
    return absl::nullopt;
  }
  if (after == readings.BeginOfTrajectory(trajectory_id)) {
    return after->time == time ? pose_after : absl::nullopt;
  }
  const auto before = std::prev(after);
  const auto pose_before = PoseOf(*before);
  if (!pose_before.has_value()) {
    return absl::nullopt;
  }
  return transform::Interpolate(
             transform::TimestampedTransform{before->time, *pose_before},
             transform::TimestampedTransform{after->time, *pose_after}, time)
      .transform;
}

// Whether a reading of `time` continues the trajectory.
template <typename DataType>
bool IsNewer(const sensor::MapByTime<DataType>& readings,
             const int trajectory_id, const common::Time time) {
  if (!readings.HasTrajectory(trajectory_id)) {
    return true;
  }
  const auto end = readings.EndOfTrajectory(trajectory_id);
  return end == readings.BeginOfTrajectory(trajectory_id) ||
         std::prev(end)->time < time;
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_OPTIMIZATION_SENSOR_READINGS_H_
