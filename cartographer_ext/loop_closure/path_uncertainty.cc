// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/path_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Covariance of one step, in the frame of its end.
Eigen::Matrix3d StepCovariance(const PathNoiseOptions& options,
                               const bool has_jumps, const double metres,
                               const double radians) {
  const double far =
      has_jumps ? std::max(0., metres - options.free_metres) : 0.;
  const double round =
      has_jumps ? std::max(0., radians - options.free_radians) : 0.;
  const double translation = Squared(options.translation_per_metre) * metres +
                             Squared(options.translation_per_radian) * radians +
                             Squared(far);
  const double rotation = Squared(options.rotation_per_metre) * metres +
                          Squared(options.rotation_per_radian) * radians +
                          Squared(round);
  return Eigen::Vector3d(translation, translation, rotation).asDiagonal();
}

// Keeps efforts finite where driving is said to be exact.
constexpr double kLeastNoise = 1e-4;

}  // namespace

PathUncertainty::PathUncertainty(const PathNoiseOptions& options,
                                 const int max_nodes)
    : options_(options),
      max_nodes_(static_cast<size_t>(std::max(max_nodes, 1))) {
  CHECK_GT(max_nodes, 0);
}

void PathUncertainty::Add(const NodeKey& node, const Pose2& local_pose) {
  Trajectory& trajectory = trajectories_[node.trajectory_id];
  std::deque<Entry>& entries = trajectory.entries;
  auto place = std::lower_bound(entries.begin(), entries.end(), node.node_index,
                                [](const Entry& entry, const int index) {
                                  return entry.node_index < index;
                                });
  if (place != entries.end() && place->node_index == node.node_index) return;
  if (entries.size() == max_nodes_ && place == entries.begin()) return;
  Entry entry;
  entry.node_index = node.node_index;
  entry.local_pose = local_pose;
  const size_t offset = static_cast<size_t>(place - entries.begin());
  entries.insert(place, entry);
  trajectory.num_valid = std::min(trajectory.num_valid, offset);
  if (entries.size() > max_nodes_) {
    // Differences of sums do not need the oldest ones. Without any valid sum
    // the first entry that is left starts from zero.
    entries.pop_front();
    if (trajectory.num_valid > 0) --trajectory.num_valid;
  }
}

const PathUncertainty::Entry* PathUncertainty::Find(const NodeKey& node) const {
  const auto it = trajectories_.find(node.trajectory_id);
  if (it == trajectories_.end()) return nullptr;
  Trajectory& trajectory = it->second;
  std::deque<Entry>& entries = trajectory.entries;
  for (; trajectory.num_valid < entries.size(); ++trajectory.num_valid) {
    Entry& entry = entries[trajectory.num_valid];
    entry.travelled = 0.;
    entry.effort = 0.;
    entry.sum.setZero();
    entry.drift.setZero();
    entry.scale.setZero();
    if (trajectory.num_valid == 0) continue;
    const Entry& before = entries[trajectory.num_valid - 1];
    const Pose2 step =
        cartographer_ext::Between(before.local_pose, entry.local_pose);
    const double metres = step.translation().norm();
    const Eigen::Matrix3d transport = Adjoint(entry.local_pose);
    const Eigen::Matrix3d covariance = StepCovariance(
        options_, node.trajectory_id >= 0, metres, std::abs(step.theta));
    entry.travelled = before.travelled + metres;
    entry.effort = before.effort + EffortOf(covariance);
    entry.sum = before.sum + transport * covariance * transport.transpose();
    entry.drift = before.drift + transport * Eigen::Vector3d(0., 0., metres);
    // The step's way in the frame of its end.
    const Eigen::Vector2d way = -step.Inverse().translation();
    entry.scale =
        before.scale + transport * Eigen::Vector3d(way.x(), way.y(), 0.);
  }
  const auto place =
      std::lower_bound(entries.begin(), entries.end(), node.node_index,
                       [](const Entry& entry, const int index) {
                         return entry.node_index < index;
                       });
  if (place == entries.end() || place->node_index != node.node_index) {
    return nullptr;
  }
  return &*place;
}

absl::optional<UncertainPose> PathUncertainty::Between(const NodeKey& u,
                                                       const NodeKey& v) const {
  if (u.trajectory_id != v.trajectory_id) return absl::nullopt;
  if (v.node_index < u.node_index) {
    const absl::optional<UncertainPose> forward = Between(v, u);
    if (!forward.has_value()) return absl::nullopt;
    return Invert(*forward);
  }
  const Entry* const from = Find(u);
  const Entry* const to = Find(v);
  if (from == nullptr || to == nullptr) return absl::nullopt;
  UncertainPose result;
  result.pose = cartographer_ext::Between(from->local_pose, to->local_pose);
  const Eigen::Matrix3d transport = Adjoint(to->local_pose.Inverse());
  const Eigen::Vector3d drift =
      options_.heading_drift * (to->drift - from->drift);
  const Eigen::Vector3d scale =
      options_.scale_error * (to->scale - from->scale);
  const Eigen::Matrix3d covariance =
      transport *
      (to->sum - from->sum + drift * drift.transpose() +
       scale * scale.transpose()) *
      transport.transpose();
  result.covariance = Symmetric(covariance);
  return result;
}

absl::optional<double> PathUncertainty::Difference(
    const NodeKey& u, const NodeKey& v, double Entry::*const sum) const {
  if (u.trajectory_id != v.trajectory_id) return absl::nullopt;
  const Entry* const from = Find(u);
  const Entry* const to = Find(v);
  if (from == nullptr || to == nullptr) return absl::nullopt;
  return std::abs(to->*sum - from->*sum);
}

absl::optional<double> PathUncertainty::Travelled(const NodeKey& u,
                                                  const NodeKey& v) const {
  return Difference(u, v, &Entry::travelled);
}

absl::optional<double> PathUncertainty::Effort(const NodeKey& u,
                                               const NodeKey& v) const {
  return Difference(u, v, &Entry::effort);
}

double PathUncertainty::EffortOf(const Eigen::Matrix3d& covariance) const {
  // Each of the two kinds in metres of driving.
  return covariance(0, 0) /
             Squared(std::max(options_.translation_per_metre, kLeastNoise)) +
         covariance(2, 2) /
             Squared(std::max(options_.rotation_per_metre, kLeastNoise));
}

absl::optional<Pose2> PathUncertainty::LocalPose(const NodeKey& node) const {
  const Entry* const entry = Find(node);
  if (entry == nullptr) return absl::nullopt;
  return entry->local_pose;
}

absl::optional<NodeKey> PathUncertainty::Nearest(
    const int trajectory_id, const Eigen::Vector2d& local_position) const {
  return Nearest(trajectory_id, local_position, std::numeric_limits<int>::min(),
                 std::numeric_limits<int>::max());
}

absl::optional<NodeKey> PathUncertainty::Nearest(
    const int trajectory_id, const Eigen::Vector2d& local_position,
    const int first, const int last) const {
  const auto it = trajectories_.find(trajectory_id);
  if (it == trajectories_.end()) return absl::nullopt;
  const std::deque<Entry>& entries = it->second.entries;
  absl::optional<NodeKey> nearest;
  double nearest_distance = std::numeric_limits<double>::infinity();
  for (auto entry = std::lower_bound(
           entries.begin(), entries.end(), first,
           [](const Entry&e, const int index) { return e.node_index < index; });
       entry != entries.end() && entry->node_index <= last; ++entry) {
    const double distance =
        (entry->local_pose.translation() - local_position).squaredNorm();
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = NodeKey{trajectory_id, entry->node_index};
    }
  }
  return nearest;
}

void PathUncertainty::DeleteTrajectory(const int trajectory_id) {
  trajectories_.erase(trajectory_id);
}

}  // namespace loop_closure
}  // namespace cartographer_ext
