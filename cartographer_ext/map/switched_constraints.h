// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Marks the verdicts of the robust optimisation problem in a map.
#ifndef CARTOGRAPHER_EXT_MAP_SWITCHED_CONSTRAINTS_H_
#define CARTOGRAPHER_EXT_MAP_SWITCHED_CONSTRAINTS_H_

#include <vector>

#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/optimization/selection/switched_loops.h"

namespace cartographer_ext {
namespace evaluation {

// Sets GraphConstraint::switched_off for the loops named in `off` and clears it
// for all others. Returns the indices of those set; loops that the map does not
// have are ignored.
std::vector<int> MarkSwitchedOff(
    const std::vector<optimization::SwitchedLoop>& off, MapGraph* map);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_SWITCHED_CONSTRAINTS_H_
