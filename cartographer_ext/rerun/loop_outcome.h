// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Outcomes, in a re-run of a stored map, of the pairs that are loops in the
// map.
#ifndef CARTOGRAPHER_EXT_RERUN_LOOP_OUTCOME_H_
#define CARTOGRAPHER_EXT_RERUN_LOOP_OUTCOME_H_

#include <map>
#include <utility>

#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// A submap and a node.
using LoopPair = std::pair<GraphId, GraphId>;

struct LoopOutcome {
  enum class Kind {
    kTooFar,      // beyond max_constraint_distance
    kNotSampled,  // skipped by the sampler
    kSearched,
  };
  Kind kind = Kind::kTooFar;
  double distance = 0.;  // metres between the two when they were due
};

using LoopOutcomes = std::map<LoopPair, LoopOutcome>;

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_LOOP_OUTCOME_H_
