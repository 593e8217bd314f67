// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The relations metric of Kuemmerle et al. ("On measuring the accuracy of SLAM
// algorithms", Autonomous Robots 2009) in the form of Cartographer's
// compute_relations_metrics: for a reference relation between the stamps t1 and
// t2,
//
//   error = (pose(t1)^-1 * pose(t2)) * expected^-1,
//
// of which the length of the translation and the angle of the rotation are
// taken. No alignment is needed, and an error far away does not affect
// relations that are locally right. The length of the translation depends on
// the direction of the relation (an error of rotation acts on the expected
// translation), so relations are used as given.
//
// A folded map has small errors in the relations between consecutive scans.
// They are therefore reported separately from those that close a loop, defined
// as those whose stamps are more than a minute apart.
#ifndef CARTOGRAPHER_EXT_METRICS_RELATIONS_METRIC_H_
#define CARTOGRAPHER_EXT_METRICS_RELATIONS_METRIC_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/metrics/statistics.h"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

using Relation = io::StampedRelation;

struct RelationError {
  io::TimeNs time1 = 0;
  io::TimeNs time2 = 0;
  bool is_loop = false;
  double translation = 0.;  // metres
  double rotation = 0.;     // radians
};

struct RelationsSummary {
  int64_t count = 0;
  Statistics translation;          // metres
  Statistics squared_translation;  // square metres
  Statistics rotation_degrees;
  Statistics squared_rotation_degrees;
  double fraction_above_half_metre = 0.;
};

struct RelationsMetric {
  RelationsSummary all;
  RelationsSummary loop;
  RelationsSummary sequential;
  // Relations with a stamp outside the trajectory.
  int64_t num_not_covered = 0;
  std::vector<RelationError> errors;  // in the order of the relations
};

struct RelationsMetricOptions {
  // Stamps within this distance belong to the same scan; 0 always interpolates.
  io::TimeNs stamp_tolerance = 1000000;
  io::TimeNs loop_time_gap = 60LL * 1000000000LL;
};

// An error if no relation is within the trajectory.
absl::StatusOr<RelationsMetric> ComputeRelationsMetric(
    const Trajectory& trajectory, const std::vector<Relation>& relations,
    const RelationsMetricOptions& options);

// CSV with a header line: the error of every relation.
std::string RelationErrorTable(const RelationsMetric& metric);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_METRICS_RELATIONS_METRIC_H_
