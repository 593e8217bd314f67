// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Common loops of two runs of one map. A loop is a pair of a submap and a node.
// With every third candidate searched, two runs whose poses differ by a
// millimetre may search different nodes of one visit; so a loop of the other
// run between the same submap and a nearby node is also counted.
#ifndef CARTOGRAPHER_EXT_RERUN_LOOP_COMPARISON_H_
#define CARTOGRAPHER_EXT_RERUN_LOOP_COMPARISON_H_

#include <string>
#include <vector>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/rerun/loop_outcome.h"

namespace cartographer_ext {
namespace evaluation {

struct LoopComparisonOptions {
  int node_tolerance = 5;                // nodes, of the same visit
  double pose_tolerance = 0.05;          // metres, for the same pose
  double max_constraint_distance = 15.;  // metres, of the other run
  // Outcomes of the loops of the first graph in the run that made the second;
  // null if unknown. Then only the final poses of the second graph are used.
  const LoopOutcomes* outcomes = nullptr;
};

// Why a loop of the first graph is missing in the second.
enum class LoopAbsence {
  kPresent,
  kNeighbourInstead,  // a nearby node is constrained to the submap
  kTooFar,            // beyond the distance limit in the other graph
  kOtherVisit,        // within the distance limit in the other graph
  kNotSampled,        // skipped by the sampler
  kNoMatch,           // searched without a match
};

struct LoopComparison {
  int64_t first = 0;
  int64_t second = 0;
  int64_t common = 0;
  int64_t common_same_pose = 0;   // of these, within the tolerance
  double fraction_of_first = 1.;  // common / first, 1 for none
  double fraction_of_second = 1.;
  int64_t neighbour_instead = 0;
  int64_t too_far = 0;
  int64_t other_visit = 0;
  // Only with outcomes; then these, `too_far` and `other_visit` add up to the
  // missing loops, some of which are also counted in `neighbour_instead`.
  int64_t not_sampled = 0;
  int64_t no_match = 0;
  double max_pose_difference = 0.;  // metres, of common ones
  // For each loop of the first graph in the order of its constraints.
  std::vector<LoopAbsence> absences;
};

LoopComparison CompareLoops(const MapGraph& first, const MapGraph& second,
                            const LoopComparisonOptions& options);

// A sentence on the reasons for missing loops; empty if there are none.
std::string ExplainMissing(const LoopComparison& comparison);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_LOOP_COMPARISON_H_
