// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The ideal map of a run: exact scans of the plan alone (no moving obstacle, no
// noise) from the true poses. Cells passed by a beam are free, cells a beam
// ends in are occupied, the others unknown.
#ifndef CARTOGRAPHER_EXT_SIMULATION_TRUTH_MAP_H_
#define CARTOGRAPHER_EXT_SIMULATION_TRUTH_MAP_H_

#include "absl/status/statusor.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/simulation/simulation.h"

namespace cartographer_ext {
namespace simulation {

// `resolution` in metres per cell. The map's frame is the world; its borders
// are multiples of the resolution. An error when it would need more than 64
// million cells.
absl::StatusOr<io::OccupancyMap> MakeTruthMap(const Simulation& simulation,
                                              double resolution);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_TRUTH_MAP_H_
