// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Which loops two runs over one map have in common. A loop is a pair of a
// submap and a node. Searching every third candidate, two runs whose poses
// differ by a millimetre may try different nodes of one visit; so a loop also
// counts as alike where the other run ties the same submap to a node near by.
#ifndef CARTOGRAPHER_EXT_RERUN_LOOP_COMPARISON_H_
#define CARTOGRAPHER_EXT_RERUN_LOOP_COMPARISON_H_

#include <string>
#include <vector>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/rerun/loop_fate.h"

namespace cartographer_ext {
namespace evaluation {

struct LoopComparisonOptions {
  int node_tolerance = 5;                // nodes, of the same visit
  double pose_tolerance = 0.05;          // metres, for the same place
  double max_constraint_distance = 15.;  // metres, of the other run
  // What became of the loops of the first graph in the run that made the
  // second; null where that is not known. Then places in the second graph, as
  // its run left it, are all there is to go by.
  const LoopFates* fates = nullptr;
};

// Why a loop of the first is not in the second.
enum class LoopAbsence {
  kPresent,
  kNeighbourInstead,  // a node near by is tied to the submap
  kTooFar,            // the other graph has them too far apart to search
  kOtherVisit,        // the other graph could have had it
  kNotSampled,        // the sampler took other candidates of the submap
  kNoMatch,           // searched without a match
};

struct LoopComparison {
  int64_t first = 0;
  int64_t second = 0;
  int64_t common = 0;
  int64_t common_same_pose = 0;   // of these, to the tolerance
  double fraction_of_first = 1.;  // common / first, 1 for none
  double fraction_of_second = 1.;
  int64_t neighbour_instead = 0;
  int64_t too_far = 0;
  int64_t other_visit = 0;
  // Only with fates; then these, `too_far` and `other_visit` make up what is
  // missing, and `neighbour_instead` counts some of it again.
  int64_t not_sampled = 0;
  int64_t no_match = 0;
  double max_pose_difference = 0.;  // metres, of common ones
  // For each loop of the first graph in the order of its constraints.
  std::vector<LoopAbsence> absences;
};

LoopComparison CompareLoops(const MapGraph& first, const MapGraph& second,
                            const LoopComparisonOptions& options);

// A sentence for people on why loops are missing; empty when none is.
std::string ExplainMissing(const LoopComparison& comparison);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_LOOP_COMPARISON_H_
