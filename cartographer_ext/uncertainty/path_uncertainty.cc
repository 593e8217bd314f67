// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/path_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/common/squared.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

// Covariance of one step, in the frame of its end.
CovarianceParts StepCovariance(const PathNoiseOptions& options,
                               const JumpThresholds& thresholds,
                               const double metres, const double radians) {
  const auto diagonal = [](const double translation, const double rotation) {
    return Eigen::Matrix3d(
        Eigen::Vector3d(translation, translation, rotation).asDiagonal());
  };
  CovarianceParts parts;
  parts.translation =
      diagonal(Squared(options.translation_per_metre) * metres +
                   Squared(options.translation_per_radian) * radians,
               0.);
  parts.rotation = diagonal(0., Squared(options.rotation_per_metre) * metres);
  parts.turning = diagonal(0., Squared(options.rotation_per_radian) * radians);
  parts.other = diagonal(Squared(std::max(0., metres - thresholds.metres)),
                         Squared(std::max(0., radians - thresholds.radians)));
  return parts;
}

// Preceding steps that determine what is ordinary: enough to outlast a turn on
// the spot, in which the robot hardly moves; fewer than the minimum are not
// used.
constexpr size_t kMostStepsBefore = 31;
constexpr size_t kFewestStepsBefore = 3;
// The first steps are compared with those that follow, among so many vertices.
constexpr size_t kFirstVertices = kFewestStepsBefore + 2;
// One step in ten may be a jump; up to 1.5 times the largest of the others is
// ordinary.
constexpr size_t kJumpsOneIn = 10;
constexpr double kOrdinary = 1.5;

// Keeps costs finite where driving is configured to be exact.
constexpr double kMinNoise = 1e-4;

// The indices increase, and mostly by one.
template <typename Entries>
auto LowerBound(Entries& entries, const int index)
    -> decltype(entries.begin()) {
  if (!entries.empty() && entries.front().index <= index) {
    const size_t offset = static_cast<size_t>(index - entries.front().index);
    if (offset < entries.size() && entries[offset].index == index) {
      return entries.begin() + static_cast<ptrdiff_t>(offset);
    }
  }
  return std::lower_bound(entries.begin(), entries.end(), index,
                          [](const typename Entries::value_type& entry,
                             const int value) { return entry.index < value; });
}

}  // namespace

PathNoiseOptions Scaled(const PathNoiseOptions& noise,
                        const DriftFactors& factors) {
  PathNoiseOptions scaled = noise;
  scaled.translation_per_metre *= factors.translation;
  scaled.translation_per_radian *= factors.translation;
  scaled.rotation_per_metre *= factors.rotation;
  scaled.rotation_per_radian *= factors.turning;
  return scaled;
}

CommonDrift PriorCommonDrift(const PathNoiseOptions& options) {
  CommonDrift prior;
  prior.covariance.diagonal() << Squared(options.heading_drift), 0.,
      Squared(options.scale_error);
  return prior;
}

Eigen::Matrix3d CovarianceParts::Total(
    const DriftFactors& factors,
    const Eigen::Matrix3d& common_covariance) const {
  return Squared(factors.translation) * translation +
         Squared(factors.rotation) * rotation +
         Squared(factors.turning) * turning +
         common * common_covariance * common.transpose() + other;
}

CovarianceParts& CovarianceParts::operator+=(const CovarianceParts& parts) {
  translation += parts.translation;
  rotation += parts.rotation;
  turning += parts.turning;
  common += parts.common;
  other += parts.other;
  return *this;
}

CovarianceParts& CovarianceParts::operator-=(const CovarianceParts& parts) {
  translation -= parts.translation;
  rotation -= parts.rotation;
  turning -= parts.turning;
  common -= parts.common;
  other -= parts.other;
  return *this;
}

CovarianceParts Transported(const CovarianceParts& parts,
                            const Eigen::Matrix3d& adjoint) {
  CovarianceParts result;
  result.translation = adjoint * parts.translation * adjoint.transpose();
  result.rotation = adjoint * parts.rotation * adjoint.transpose();
  result.turning = adjoint * parts.turning * adjoint.transpose();
  result.common = adjoint * parts.common;
  result.other = adjoint * parts.other * adjoint.transpose();
  return result;
}

PathUncertainty::PathUncertainty(const PathNoiseOptions& options,
                                 const int max_vertices)
    : options_(options),
      max_vertices_(static_cast<size_t>(std::max(max_vertices, 1))) {
  CHECK_GT(max_vertices, 0);
}

void PathUncertainty::Add(const VertexId& vertex, const Pose2& local_pose,
                          const StepError& error) {
  Sequence& sequence = sequences_[KeyOf(vertex)];
  std::deque<Entry>& entries = sequence.entries;
  const auto place = LowerBound(entries, vertex.index());
  if (place != entries.end() && place->index == vertex.index()) return;
  if (entries.size() == max_vertices_ && place == entries.begin()) return;
  Entry entry;
  entry.index = vertex.index();
  entry.local_pose = local_pose;
  entry.error = error;
  const size_t offset = static_cast<size_t>(place - entries.begin());
  entries.insert(place, entry);
  sequence.num_valid = std::min(sequence.num_valid, offset);
  if (entries.size() <= kFirstVertices) {
    sequence.num_valid = std::min(sequence.num_valid, size_t{1});
  }
  if (entries.size() > max_vertices_) {
    // Differences of sums do not need the oldest ones. Without any valid sum
    // the first entry that remains starts from zero.
    entries.pop_front();
    if (sequence.num_valid > 0) --sequence.num_valid;
  }
}

JumpThresholds PathUncertainty::Thresholds(const std::deque<Entry>& entries,
                                           const size_t position) const {
  JumpThresholds thresholds;
  thresholds.metres = options_.jump_threshold_metres;
  thresholds.radians = options_.jump_threshold_radians;
  const bool at_beginning = position <= kFewestStepsBefore;
  const size_t first =
      position > kMostStepsBefore ? position - kMostStepsBefore : 1;
  const size_t end =
      at_beginning ? std::min(entries.size(), kFirstVertices) : position;
  std::vector<double> metres;
  std::vector<double> radians;
  for (size_t i = first; i < end; ++i) {
    if (i == position) continue;
    const double num_steps = entries[i].index - entries[i - 1].index;
    metres.push_back(entries[i].step.translation().norm() / num_steps);
    radians.push_back(std::abs(entries[i].step.theta) / num_steps);
  }
  if (metres.size() < kFewestStepsBefore) return thresholds;
  std::sort(metres.begin(), metres.end());
  std::sort(radians.begin(), radians.end());
  const double stride =
      std::max(1., 2. * metres[metres.size() / 2] / thresholds.metres);
  const size_t large = metres.size() - 1 - metres.size() / kJumpsOneIn;
  thresholds.metres =
      std::max(stride * thresholds.metres, kOrdinary * metres[large]);
  thresholds.radians =
      std::max(stride * thresholds.radians, kOrdinary * radians[large]);
  return thresholds;
}

void PathUncertainty::Accumulate(JumpThresholds thresholds,
                                 const Eigen::Vector3d& common,
                                 const Entry& before,
                                 Entry* const entry) const {
  const Pose2& step = entry->step;
  const double metres = step.translation().norm();
  const Pose2 corrected((1. + common.z()) * step.x, (1. + common.z()) * step.y,
                        (1. + common.y()) * step.theta + common.x() * metres);
  entry->corrected = before.corrected * corrected;
  thresholds.metres *= entry->index - before.index;
  thresholds.radians *= entry->index - before.index;
  CovarianceParts step_parts =
      StepCovariance(options_, thresholds, metres, std::abs(step.theta));
  if (entry->error.bridged.has_value()) {
    step_parts.other = *entry->error.bridged;
  }
  step_parts.other += entry->error.doubt;
  entry->travelled = before.travelled + metres;
  entry->cost = before.cost + PathCostOf(step_parts.Total(
                                  DriftFactors(), Eigen::Matrix3d::Zero()));
  CovarianceParts parts = step_parts;
  parts.common.col(0) = Eigen::Vector3d(0., 0., metres);
  parts.common.col(1) = Eigen::Vector3d(0., 0., step.theta);
  // The translation of the step in the frame of its end.
  parts.common.col(2).head<2>() = -step.Inverse().translation();
  parts = Transported(parts, Adjoint(entry->corrected));
  entry->sum = before.sum;
  entry->sum += parts;
}

const PathUncertainty::Entry* PathUncertainty::Find(
    const VertexId& vertex) const {
  const auto it = sequences_.find(KeyOf(vertex));
  if (it == sequences_.end()) return nullptr;
  Sequence& sequence = it->second;
  std::deque<Entry>& entries = sequence.entries;
  if (sequence.num_valid < entries.size()) {
    const Eigen::Vector3d common = Common(vertex.trajectory_id()).mean;
    for (size_t i = std::max(sequence.num_valid, size_t{1}); i < entries.size();
         ++i) {
      entries[i].step = cartographer_ext::Between(entries[i - 1].local_pose,
                                                  entries[i].local_pose);
    }
    for (; sequence.num_valid < entries.size(); ++sequence.num_valid) {
      Entry& entry = entries[sequence.num_valid];
      entry.travelled = 0.;
      entry.cost = 0.;
      entry.sum = CovarianceParts();
      entry.corrected = entry.local_pose;
      if (sequence.num_valid == 0) continue;
      // Submaps are as far apart as their size, so none of their steps is a
      // jump.
      Accumulate(vertex.is_node() ? Thresholds(entries, sequence.num_valid)
                                  : JumpThresholds(),
                 common, entries[sequence.num_valid - 1], &entry);
    }
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
  result.pose = cartographer_ext::Between(from->corrected, to->corrected);
  result.covariance =
      Symmetric(PartsBetween(*from, *to)
                    .Total(Drift(u.trajectory_id()),
                           Common(u.trajectory_id()).covariance));
  return result;
}

CovarianceParts PathUncertainty::PartsBetween(const Entry& from,
                                              const Entry& to) const {
  CovarianceParts sum = to.sum;
  sum -= from.sum;
  return Transported(sum, Adjoint(to.corrected.Inverse()));
}

absl::optional<CovarianceParts> PathUncertainty::Parts(
    const VertexId& u, const VertexId& v) const {
  if (!u.InSequenceWith(v)) return absl::nullopt;
  const Entry* const from = Find(u);
  const Entry* const to = Find(v);
  if (from == nullptr || to == nullptr) return absl::nullopt;
  if (u.index() <= v.index()) return PartsBetween(*from, *to);
  // Seen from the other end, as Invert() does.
  CovarianceParts parts = Transported(
      PartsBetween(*to, *from),
      Adjoint(cartographer_ext::Between(to->corrected, from->corrected)));
  parts.common = -parts.common;
  return parts;
}

void PathUncertainty::SetDrift(const int trajectory_id,
                               const DriftFactors& factors,
                               const CommonDrift& common) {
  drift_[trajectory_id] = TrajectoryDrift{factors, common};
  ++drift_version_;
  for (auto& sequence : sequences_) {
    if (sequence.first.second == trajectory_id) sequence.second.num_valid = 0;
  }
}

DriftFactors PathUncertainty::Drift(const int trajectory_id) const {
  const auto found = drift_.find(trajectory_id);
  return found == drift_.end() ? DriftFactors() : found->second.factors;
}

CommonDrift PathUncertainty::Common(const int trajectory_id) const {
  const auto found = drift_.find(trajectory_id);
  return found == drift_.end() ? PriorCommonDrift(options_)
                               : found->second.common;
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
  drift_.erase(trajectory_id);
}

}  // namespace uncertainty
}  // namespace cartographer_ext
