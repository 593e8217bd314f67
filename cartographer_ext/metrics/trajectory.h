// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A trajectory for the metrics: poses in order of time, with lookup by time.
#ifndef CARTOGRAPHER_EXT_METRICS_TRAJECTORY_H_
#define CARTOGRAPHER_EXT_METRICS_TRAJECTORY_H_

#include <vector>

#include "Eigen/Geometry"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/io/trajectory_file.h"

namespace cartographer_ext {
namespace evaluation {

using io::StampedPose;  // (map <- robot) at a time

// Planar pose as a spatial one, z = roll = pitch = 0.
Eigen::Isometry3d ToIsometry(const Pose2& pose);

// x, y and yaw (about z, of the x axis projected to the plane).
Pose2 ToPose2(const Eigen::Isometry3d& pose);

// Angle of the rotation in radians, in [0, pi].
double RotationAngle(const Eigen::Isometry3d& pose);

class Trajectory {
 public:
  Trajectory() = default;
  // Sorts by time; of equal stamps the first is kept.
  explicit Trajectory(std::vector<StampedPose> poses);

  // The pose whose stamp is nearest, if it is at most `tolerance` away;
  // otherwise interpolated between the two neighbours in time (linear in
  // translation, spherical in rotation). Empty outside the covered time span. A
  // tolerance of 0 always interpolates, as Cartographer's own tool does.
  absl::optional<Eigen::Isometry3d> Lookup(io::TimeNs time,
                                           io::TimeNs tolerance) const;

  // Distance to the nearest stamp; the largest value when empty.
  io::TimeNs DistanceToNearestStamp(io::TimeNs time) const;

  const std::vector<StampedPose>& poses() const { return poses_; }
  bool empty() const { return poses_.empty(); }

  // Sum of the translations between successive poses, in metres.
  double Length() const;

 private:
  std::vector<StampedPose> poses_;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_METRICS_TRAJECTORY_H_
