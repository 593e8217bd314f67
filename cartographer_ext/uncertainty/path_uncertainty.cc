// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/path_uncertainty.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

// Covariance of one step, in the frame of its end. Only steps between nodes can
// be jumps; submaps are as far apart as their size.
Eigen::Matrix3d StepCovariance(const PathNoiseOptions& options,
                               const bool are_nodes, const double metres,
                               const double radians) {
  const double jump =
      are_nodes ? std::max(0., metres - options.jump_threshold_metres) : 0.;
  const double turn =
      are_nodes ? std::max(0., radians - options.jump_threshold_radians) : 0.;
  const double translation = Squared(options.translation_per_metre) * metres +
                             Squared(options.translation_per_radian) * radians +
                             Squared(jump);
  const double rotation = Squared(options.rotation_per_metre) * metres +
                          Squared(options.rotation_per_radian) * radians +
                          Squared(turn);
  return Eigen::Vector3d(translation, translation, rotation).asDiagonal();
}

// Keeps costs finite where driving is configured to be exact.
constexpr double kMinNoise = 1e-4;

template <typename Entries>
auto LowerBound(Entries& entries, const int index)
    -> decltype(entries.begin()) {
  return std::lower_bound(entries.begin(), entries.end(), index,
                          [](const typename Entries::value_type& entry,
                             const int value) { return entry.index < value; });
}

}  // namespace

PathUncertainty::PathUncertainty(const PathNoiseOptions& options,
                                 const int max_vertices)
    : options_(options),
      max_vertices_(static_cast<size_t>(std::max(max_vertices, 1))) {
  CHECK_GT(max_vertices, 0);
}

void PathUncertainty::Add(const VertexId& vertex, const Pose2& local_pose) {
  Sequence& sequence = sequences_[KeyOf(vertex)];
  std::deque<Entry>& entries = sequence.entries;
  const auto place = LowerBound(entries, vertex.index());
  if (place != entries.end() && place->index == vertex.index()) return;
  if (entries.size() == max_vertices_ && place == entries.begin()) return;
  Entry entry;
  entry.index = vertex.index();
  entry.local_pose = local_pose;
  const size_t offset = static_cast<size_t>(place - entries.begin());
  entries.insert(place, entry);
  sequence.num_valid = std::min(sequence.num_valid, offset);
  if (entries.size() > max_vertices_) {
    // Differences of sums do not need the oldest ones. Without any valid sum
    // the first entry that remains starts from zero.
    entries.pop_front();
    if (sequence.num_valid > 0) --sequence.num_valid;
  }
}

void PathUncertainty::Accumulate(const bool are_nodes, const Entry& before,
                                 Entry* const entry) const {
  const Pose2 step =
      cartographer_ext::Between(before.local_pose, entry->local_pose);
  const double metres = step.translation().norm();
  const Eigen::Matrix3d adjoint = Adjoint(entry->local_pose);
  const Eigen::Matrix3d covariance =
      StepCovariance(options_, are_nodes, metres, std::abs(step.theta));
  entry->travelled = before.travelled + metres;
  entry->cost = before.cost + PathCostOf(covariance);
  entry->sum = before.sum + adjoint * covariance * adjoint.transpose();
  entry->drift = before.drift + adjoint * Eigen::Vector3d(0., 0., metres);
  // The translation of the step in the frame of its end.
  const Eigen::Vector2d translation = -step.Inverse().translation();
  entry->scale = before.scale + adjoint * Eigen::Vector3d(translation.x(),
                                                          translation.y(), 0.);
}

const PathUncertainty::Entry* PathUncertainty::Find(
    const VertexId& vertex) const {
  const auto it = sequences_.find(KeyOf(vertex));
  if (it == sequences_.end()) return nullptr;
  Sequence& sequence = it->second;
  std::deque<Entry>& entries = sequence.entries;
  for (; sequence.num_valid < entries.size(); ++sequence.num_valid) {
    Entry& entry = entries[sequence.num_valid];
    entry.travelled = 0.;
    entry.cost = 0.;
    entry.sum.setZero();
    entry.drift.setZero();
    entry.scale.setZero();
    if (sequence.num_valid == 0) continue;
    Accumulate(vertex.is_node(), entries[sequence.num_valid - 1], &entry);
  }
  const auto place = LowerBound(entries, vertex.index());
  if (place == entries.end() || place->index != vertex.index()) return nullptr;
  return &*place;
}

absl::optional<UncertainPose> PathUncertainty::Between(
    const VertexId& u, const VertexId& v) const {
  if (!u.InSequenceWith(v)) return absl::nullopt;
  if (v.index() < u.index()) {
    const absl::optional<UncertainPose> forward = Between(v, u);
    if (!forward.has_value()) return absl::nullopt;
    return Invert(*forward);
  }
  const Entry* const from = Find(u);
  const Entry* const to = Find(v);
  if (from == nullptr || to == nullptr) return absl::nullopt;
  UncertainPose result;
  result.pose = cartographer_ext::Between(from->local_pose, to->local_pose);
  const Eigen::Matrix3d adjoint = Adjoint(to->local_pose.Inverse());
  const Eigen::Vector3d drift =
      options_.heading_drift * (to->drift - from->drift);
  const Eigen::Vector3d scale =
      options_.scale_error * (to->scale - from->scale);
  const Eigen::Matrix3d covariance =
      adjoint *
      (to->sum - from->sum + drift * drift.transpose() +
       scale * scale.transpose()) *
      adjoint.transpose();
  result.covariance = Symmetric(covariance);
  return result;
}

absl::optional<double> PathUncertainty::Difference(
    const VertexId& u, const VertexId& v, double Entry::*const sum) const {
  if (!u.InSequenceWith(v)) return absl::nullopt;
  const Entry* const from = Find(u);
  const Entry* const to = Find(v);
  if (from == nullptr || to == nullptr) return absl::nullopt;
  return std::abs(to->*sum - from->*sum);
}

absl::optional<double> PathUncertainty::Travelled(const VertexId& u,
                                                  const VertexId& v) const {
  return Difference(u, v, &Entry::travelled);
}

absl::optional<double> PathUncertainty::PathCost(const VertexId& u,
                                                 const VertexId& v) const {
  return Difference(u, v, &Entry::cost);
}

double PathUncertainty::PathCostOf(const Eigen::Matrix3d& covariance) const {
  // Translation and rotation, each in metres of driving.
  return covariance(0, 0) /
             Squared(std::max(options_.translation_per_metre, kMinNoise)) +
         covariance(2, 2) /
             Squared(std::max(options_.rotation_per_metre, kMinNoise));
}

absl::optional<Pose2> PathUncertainty::LocalPose(const VertexId& vertex) const {
  const Entry* const entry = Find(vertex);
  if (entry == nullptr) return absl::nullopt;
  return entry->local_pose;
}

absl::optional<NodeId> PathUncertainty::Nearest(
    const int trajectory_id, const Eigen::Vector2d& local_position) const {
  return Nearest(trajectory_id, local_position, std::numeric_limits<int>::min(),
                 std::numeric_limits<int>::max());
}

absl::optional<NodeId> PathUncertainty::Nearest(
    const int trajectory_id, const Eigen::Vector2d& local_position,
    const int first, const int last) const {
  const auto it = sequences_.find(KeyOf(NodeId{trajectory_id, 0}));
  if (it == sequences_.end()) return absl::nullopt;
  const std::deque<Entry>& entries = it->second.entries;
  absl::optional<NodeId> nearest;
  double nearest_distance = std::numeric_limits<double>::infinity();
  for (auto entry = LowerBound(entries, first);
       entry != entries.end() && entry->index <= last; ++entry) {
    const double distance =
        (entry->local_pose.translation() - local_position).squaredNorm();
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = NodeId{trajectory_id, entry->index};
    }
  }
  return nearest;
}

void PathUncertainty::DeleteTrajectory(const int trajectory_id) {
  sequences_.erase(KeyOf(NodeId{trajectory_id, 0}));
  sequences_.erase(KeyOf(SubmapId{trajectory_id, 0}));
}

}  // namespace uncertainty
}  // namespace cartographer_ext
