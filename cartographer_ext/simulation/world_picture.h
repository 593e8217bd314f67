// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A picture of a run: walls, the drive, moving obstacles with their loops,
// marked places, key distances and odometry faults.
#ifndef CARTOGRAPHER_EXT_SIMULATION_WORLD_PICTURE_H_
#define CARTOGRAPHER_EXT_SIMULATION_WORLD_PICTURE_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/simulation/simulation.h"

namespace cartographer_ext {
namespace simulation {

// A PNG whose longer side has `pixels` (100 to 8000) pixels.
absl::Status WriteWorldPicture(const Simulation& simulation, int pixels,
                               const std::string& filename);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_WORLD_PICTURE_H_
