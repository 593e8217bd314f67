// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Faults of the odometry and stalls of the laser at random times of a drive.
#ifndef CARTOGRAPHER_EXT_SIMULATION_RANDOM_FAULTS_H_
#define CARTOGRAPHER_EXT_SIMULATION_RANDOM_FAULTS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

// Random faults from a short description, comma separated:
//   stale:3    three bursts of 0.3 to 1 s while driving
//   jump:2     two jumps of 0.5 to 1 m, up to 20 degrees
//   slip:4     four slips of 1 to 3 s, wheels 30 to 100 % too fast
//   reverse    backwards reported as forwards, from the start
//   offset:0.12  laser and odometry clocks 0.12 s apart
// Times depend on the seed and lie at least 10 s apart.
absl::StatusOr<std::vector<OdometryFault>> RandomFaults(
    const std::string& description, const Drive& drive, uint64_t seed);

// An error where the description has another form.
absl::Status CheckRandomFaults(const std::string& description);

// So many stalls of 0.4 to 1 s while driving or turning, as far apart,
// depending on the seed.
absl::StatusOr<std::vector<ScanStall>> RandomStalls(int count,
                                                    const Drive& drive,
                                                    uint64_t seed);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_RANDOM_FAULTS_H_
