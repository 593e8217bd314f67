// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/trajectory_metrics.h"

#include <cmath>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

// Fills the relative errors: for each pair the first later one that lies
// `distance` further along the reference.
void ComputeRelativeErrors(const std::vector<PosePair>& pairs,
                           const double distance, TrajectoryErrors* result) {
  std::vector<double> travelled(pairs.size(), 0.);
  for (size_t i = 1; i < pairs.size(); ++i) {
    travelled[i] = travelled[i - 1] + (pairs[i].reference.translation() -
                                       pairs[i - 1].reference.translation())
                                          .norm();
  }
  std::vector<double> translation, rotation;
  size_t end = 0;
  for (size_t begin = 0; begin < pairs.size(); ++begin) {
    while (end < pairs.size() && travelled[end] - travelled[begin] < distance) {
      ++end;
    }
    if (end == pairs.size()) break;
    const Pose2 expected =
        Between(pairs[begin].reference, pairs[end].reference);
    const Pose2 actual = Between(pairs[begin].estimate, pairs[end].estimate);
    const Pose2 error = Between(expected, actual);
    translation.push_back(error.translation().norm());
    rotation.push_back(RadToDeg(std::abs(error.theta)));
  }
  result->rpe_distance = distance;
  result->rpe = ComputeStatistics(translation);
  result->rpe_rotation_degrees = ComputeStatistics(rotation);
}

}  // namespace

std::vector<PosePair> Associate(const Trajectory& estimate,
                                const Trajectory& reference,
                                const io::TimeNs tolerance) {
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : estimate.poses()) {
    const auto truth = reference.Lookup(pose.time, tolerance);
    if (!truth.has_value()) continue;
    pairs.push_back({pose.time, ToPose2(pose.pose), ToPose2(*truth)});
  }
  return pairs;
}

Pose2 AlignInPlane(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return Pose2();
  Eigen::Vector2d from_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_mean = Eigen::Vector2d::Zero();
  for (const PosePair& pair : pairs) {
    from_mean += pair.estimate.translation();
    to_mean += pair.reference.translation();
  }
  from_mean /= static_cast<double>(pairs.size());
  to_mean /= static_cast<double>(pairs.size());
  double cross = 0., dot = 0., heading_sin = 0., heading_cos = 0.;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector2d from = pair.estimate.translation() - from_mean;
    const Eigen::Vector2d to = pair.reference.translation() - to_mean;
    cross += from.x() * to.y() - from.y() * to.x();
    dot += from.dot(to);
    const double heading = pair.reference.theta - pair.estimate.theta;
    heading_sin += std::sin(heading);
    heading_cos += std::cos(heading);
  }
  constexpr double kNoSpread = 1e-12;  // square metres
  const double theta = std::hypot(cross, dot) > kNoSpread
                           ? std::atan2(cross, dot)
                           : std::atan2(heading_sin, heading_cos);
  const Eigen::Vector2d translation =
      to_mean - Pose2(0., 0., theta) * from_mean;
  return Pose2(translation.x(), translation.y(), theta);
}

absl::StatusOr<TrajectoryErrors> ComputeTrajectoryErrors(
    const Trajectory& estimate, const Trajectory& reference,
    const TrajectoryMetricsOptions& options) {
  if (estimate.empty() || reference.empty()) {
    return absl::InvalidArgumentError(estimate.empty()
                                          ? "the estimated trajectory is empty"
                                          : "the reference is empty");
  }
  const std::vector<PosePair> pairs =
      Associate(estimate, reference, options.stamp_tolerance);
  if (pairs.size() < 2) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the reference (%.3f s to %.3f s) covers %d of the %d estimated poses "
        "(%.3f s to %.3f s), at least 2 are needed",
        io::ToSeconds(reference.poses().front().time),
        io::ToSeconds(reference.poses().back().time), pairs.size(),
        estimate.poses().size(), io::ToSeconds(estimate.poses().front().time),
        io::ToSeconds(estimate.poses().back().time)));
  }
  TrajectoryErrors result;
  result.num_pairs = static_cast<int64_t>(pairs.size());
  result.alignment = AlignInPlane(pairs);
  std::vector<double> rotation;
  for (const PosePair& pair : pairs) {
    const Pose2 aligned = result.alignment * pair.estimate;
    result.distances.push_back(
        (aligned.translation() - pair.reference.translation()).norm());
    rotation.push_back(RadToDeg(
        std::abs(NormalizeAngle(aligned.theta - pair.reference.theta))));
  }
  result.ate = ComputeStatistics(result.distances);
  result.ate_rotation_degrees = ComputeStatistics(rotation);
  ComputeRelativeErrors(pairs, options.rpe_distance, &result);
  return result;
}

}  // namespace evaluation
}  // namespace cartographer_ext
