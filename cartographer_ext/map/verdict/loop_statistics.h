// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Correctness of the loops of a map. Each loop constraint gives the pose of a
// node in a submap. Ground truth gives relative poses of the recording: a
// reference trajectory for any two stamps, reference relations for a few pairs
// of them. A constraint is related to such a pair through the local trajectory,
// which is accurate over the few metres in between:
//
//   place a in the submap    submap_local^-1 * local(t_a)
//   place b from the node    node_local^-1 * local(t_b)
//   loop says (a <- b)       (place a)^-1 * relative_pose * (place b)
//
// and that is compared with ground truth (a <- b).
//
// Precision is the share of right loops among those covered by ground truth.
// Recall counts revisits, not loops, because one revisit gives dozens of loops
// that are the same piece of evidence: a revisit is a piece of the run that is
// near an earlier one (more than a minute before) by ground truth, and it is
// closed if one right loop connects it to the earlier time.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_LOOP_STATISTICS_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_LOOP_STATISTICS_H_

#include <vector>

#include "absl/types/optional.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/metrics/relations_metric.h"
#include "cartographer_ext/metrics/statistics.h"

namespace cartographer_ext {
namespace evaluation {

struct LoopStatisticsOptions {
  // A loop with at most this error is right.
  double correct_translation = 0.5;         // metres
  double correct_rotation = DegToRad(10.);  // radians
  io::TimeNs loop_time_gap = 60LL * 1000000000LL;
  // Reference trajectory: earlier poses within this distance make a revisit.
  double revisit_distance = 2.;  // metres
  // Reference relations: largest distance of their stamps from the node and
  // from the time span of the submap.
  io::TimeNs bridge = 3LL * 1000000000LL;
  // Pieces with shorter breaks are one revisit.
  io::TimeNs revisit_break = 10LL * 1000000000LL;
  io::TimeNs stamp_tolerance = 1000000;
};

enum class LoopVerdict { kUnknown, kCorrect, kWrong };

struct LoopJudgement {
  size_t constraint = 0;  // index into MapGraph::constraints
  LoopVerdict verdict = LoopVerdict::kUnknown;
  // Errors against ground truth; zero if unknown.
  double translation_error = 0.;  // metres
  double rotation_error = 0.;     // radians
  // Of the optimised graph.
  double residual_translation = 0.;  // metres
  double residual_rotation = 0.;     // radians
};

struct LoopStatistics {
  int64_t accepted = 0;
  // Number of matched candidates that were not accepted, from the decision
  // records; absent without records.
  absl::optional<int64_t> rejected;
  int64_t judged = 0;
  int64_t correct = 0;
  int64_t revisits = 0;
  int64_t revisits_closed = 0;
  absl::optional<double> precision;  // absent if nothing could be judged
  absl::optional<double> recall;     // absent if there is no revisit
  Statistics residual_translation;   // metres
  Statistics residual_rotation_degrees;
  std::vector<LoopJudgement> loops;  // in the order of the constraints
};

// Without ground truth: counts and residuals.
LoopStatistics ComputeLoopStatistics(const MapGraph& graph);

LoopStatistics ComputeLoopStatistics(const MapGraph& graph,
                                     const Trajectory& reference,
                                     const LoopStatisticsOptions& options);

LoopStatistics ComputeLoopStatistics(const MapGraph& graph,
                                     const std::vector<Relation>& relations,
                                     const LoopStatisticsOptions& options);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_LOOP_STATISTICS_H_
