// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Trajectories in the TUM format, which evo and others read:
//
//   timestamp tx ty tz qx qy qz qw
//
// Seconds since 1970 (or since the start of a log whose stamps are relative),
// metres, unit quaternion. Comment lines start with '#'. Compressed files are
// read transparently.
#ifndef CARTOGRAPHER_EXT_IO_TRAJECTORY_FILE_H_
#define CARTOGRAPHER_EXT_IO_TRAJECTORY_FILE_H_

#include <string>
#include <vector>

#include "Eigen/Geometry"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace io {

// (map <- robot) at `time`.
struct StampedPose {
  TimeNs time = 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

// The planar pose as one in space, z = roll = pitch = 0.
StampedPose MakeStampedPose(TimeNs time, const Pose2& pose);

// In the order of the file, which must not go backwards. Errors name file and
// line: words missing or too many, numbers that are not finite, quaternions far
// from unit length, no pose at all.
absl::StatusOr<std::vector<StampedPose>> ReadTumTrajectory(
    const std::string& filename);

// Nanosecond stamps, micrometres, atomically; "-" is standard output.
absl::Status WriteTumTrajectory(const std::vector<StampedPose>& trajectory,
                                const std::string& filename);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_TRAJECTORY_FILE_H_
