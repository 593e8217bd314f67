// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cartographer_ext {
namespace evaluation {
namespace {

bool Earlier(const StampedPose& lhs, const StampedPose& rhs) {
  return lhs.time < rhs.time;
}

}  // namespace

Eigen::Isometry3d ToIsometry(const Pose2& pose) {
  return Eigen::Translation3d(pose.x, pose.y, 0.) *
         Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ());
}

Pose2 ToPose2(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d x_axis = pose.linear().col(0);
  return Pose2(pose.translation().x(), pose.translation().y(),
               std::atan2(x_axis.y(), x_axis.x()));
}

double RotationAngle(const Eigen::Isometry3d& pose) {
  // From the quaternion: well conditioned for small angles, where the trace of
  // the matrix is not.
  const Eigen::Quaterniond q(pose.linear());
  return 2. * std::atan2(q.vec().norm(), std::abs(q.w()));
}

Trajectory::Trajectory(std::vector<StampedPose> poses)
    : poses_(std::move(poses)) {
  std::stable_sort(poses_.begin(), poses_.end(), Earlier);
  poses_.erase(std::unique(poses_.begin(), poses_.end(),
                           [](const StampedPose& a, const StampedPose& b) {
                             return a.time == b.time;
                           }),
               poses_.end());
}

absl::optional<Eigen::Isometry3d> Trajectory::Lookup(
    const io::TimeNs time, const io::TimeNs tolerance) const {
  StampedPose key;
  key.time = time;
  const auto next =
      std::lower_bound(poses_.begin(), poses_.end(), key, Earlier);
  const auto previous = next == poses_.begin() ? poses_.end() : next - 1;
  const bool has_next = next != poses_.end();
  const bool has_previous = previous != poses_.end();
  const io::TimeNs unreachable = std::numeric_limits<io::TimeNs>::max();
  const io::TimeNs to_next = has_next ? next->time - time : unreachable;
  const io::TimeNs to_previous =
      has_previous ? time - previous->time : unreachable;
  if (std::min(to_next, to_previous) <= tolerance) {
    return to_next <= to_previous ? next->pose : previous->pose;
  }
  if (!has_next || !has_previous) return absl::nullopt;
  const double ratio = static_cast<double>(to_previous) /
                       static_cast<double>(next->time - previous->time);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = (1. - ratio) * previous->pose.translation() +
                         ratio * next->pose.translation();
  result.linear() = Eigen::Quaterniond(previous->pose.linear())
                        .slerp(ratio, Eigen::Quaterniond(next->pose.linear()))
                        .toRotationMatrix();
  return result;
}

io::TimeNs Trajectory::DistanceToNearestStamp(const io::TimeNs time) const {
  StampedPose key;
  key.time = time;
  const auto next =
      std::lower_bound(poses_.begin(), poses_.end(), key, Earlier);
  io::TimeNs distance = std::numeric_limits<io::TimeNs>::max();
  if (next != poses_.end()) distance = next->time - time;
  if (next != poses_.begin()) {
    distance = std::min(distance, time - (next - 1)->time);
  }
  return distance;
}

double Trajectory::Length() const {
  double length = 0.;
  for (size_t i = 1; i < poses_.size(); ++i) {
    length += (poses_[i].pose.translation() - poses_[i - 1].pose.translation())
                  .norm();
  }
  return length;
}

}  // namespace evaluation
}  // namespace cartographer_ext
