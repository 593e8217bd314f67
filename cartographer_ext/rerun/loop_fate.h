// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What became, in a run over a stored map, of the pairs that the map ties by
// loops.
#ifndef CARTOGRAPHER_EXT_RERUN_LOOP_FATE_H_
#define CARTOGRAPHER_EXT_RERUN_LOOP_FATE_H_

#include <map>
#include <utility>

#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// A submap and a node.
using LoopPair = std::pair<GraphId, GraphId>;

struct LoopFate {
  enum class Kind {
    kTooFar,      // beyond max_constraint_distance
    kNotSampled,  // the sampler took others
    kSearched,
  };
  Kind kind = Kind::kTooFar;
  double distance = 0.;  // metres between the two when it was their turn
};

using LoopFates = std::map<LoopPair, LoopFate>;

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_RERUN_LOOP_FATE_H_
