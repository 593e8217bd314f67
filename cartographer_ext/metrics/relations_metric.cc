// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/metrics/relations_metric.h"

#include <cmath>
#include <cstdlib>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr double kBrokenMetres = 0.5;

template <typename Predicate>
RelationsSummary Summarise(const std::vector<RelationError>& errors,
                           const Predicate& selected) {
  std::vector<double> translation, squared_translation, rotation,
      squared_rotation;
  int64_t above = 0;
  for (const RelationError& error : errors) {
    if (!selected(error)) continue;
    const double degrees = RadToDeg(error.rotation);
    translation.push_back(error.translation);
    squared_translation.push_back(error.translation * error.translation);
    rotation.push_back(degrees);
    squared_rotation.push_back(degrees * degrees);
    if (error.translation > kBrokenMetres) ++above;
  }
  RelationsSummary summary;
  summary.count = static_cast<int64_t>(translation.size());
  if (summary.count > 0) {
    summary.fraction_above_half_metre =
        static_cast<double>(above) / static_cast<double>(summary.count);
  }
  summary.translation = ComputeStatistics(translation);
  summary.squared_translation = ComputeStatistics(squared_translation);
  summary.rotation_degrees = ComputeStatistics(rotation);
  summary.squared_rotation_degrees = ComputeStatistics(squared_rotation);
  return summary;
}

}  // namespace

absl::StatusOr<RelationsMetric> ComputeRelationsMetric(
    const Trajectory& trajectory, const std::vector<Relation>& relations,
    const RelationsMetricOptions& options) {
  RelationsMetric metric;
  for (const Relation& relation : relations) {
    const auto pose1 =
        trajectory.Lookup(relation.time1, options.stamp_tolerance);
    const auto pose2 =
        trajectory.Lookup(relation.time2, options.stamp_tolerance);
    if (!pose1.has_value() || !pose2.has_value()) {
      ++metric.num_not_covered;
      continue;
    }
    const Eigen::Isometry3d error =
        (pose1->inverse() * *pose2) * relation.relative.inverse();
    RelationError entry;
    entry.time1 = relation.time1;
    entry.time2 = relation.time2;
    entry.is_loop =
        std::llabs(relation.time2 - relation.time1) > options.loop_time_gap;
    entry.translation = error.translation().norm();
    entry.rotation = RotationAngle(error);
    metric.errors.push_back(entry);
  }
  if (metric.errors.empty()) {
    if (trajectory.empty() || relations.empty()) {
      return absl::InvalidArgumentError(trajectory.empty()
                                            ? "the trajectory is empty"
                                            : "there are no relations");
    }
    return absl::InvalidArgumentError(absl::StrFormat(
        "none of the %d relations lies within the trajectory (%.3f s to "
        "%.3f s; the first relation is at %.3f s): are the stamps of the same "
        "recording?",
        relations.size(), io::ToSeconds(trajectory.poses().front().time),
        io::ToSeconds(trajectory.poses().back().time),
        io::ToSeconds(relations.front().time1)));
  }
  metric.all =
      Summarise(metric.errors, [](const RelationError&) { return true; });
  metric.loop = Summarise(
      metric.errors, [](const RelationError& error) { return error.is_loop; });
  metric.sequential = Summarise(
      metric.errors, [](const RelationError& error) { return !error.is_loop; });
  return metric;
}

std::string RelationErrorTable(const RelationsMetric& metric) {
  std::string table =
      "time1,time2,is_loop,translation_error,rotation_error_degrees\n";
  for (const RelationError& error : metric.errors) {
    absl::StrAppendFormat(&table, "%.6f,%.6f,%d,%.6f,%.6f\n",
                          io::ToSeconds(error.time1),
                          io::ToSeconds(error.time2), error.is_loop ? 1 : 0,
                          error.translation, RadToDeg(error.rotation));
  }
  return table;
}

}  // namespace evaluation
}  // namespace cartographer_ext
