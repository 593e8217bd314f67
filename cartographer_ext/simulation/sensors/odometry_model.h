// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Wheel odometry of a differential drive. The true distance of a wheel follows
// from the drive, d_right/left = ds +- b / 2 dtheta with wheel base b; the
// measured distance adds scale, noise, slip and ticks (OdometrySettings), and
// the robot integrates it with its assumed wheel base:
//   ds = (d_right + d_left) / 2,  dtheta = (d_right - d_left) / b',
//   x += ds sinc(dtheta / 2) cos(theta + dtheta / 2), y likewise with sin
// (exact for a constant curvature). Noise grows with the square root of the
// distance, as for many independent small errors (Chong and Kleeman 1997).
//
// Faults are added and listed as labels. The odometry frame starts at the
// robot's start, so that its first pose is the origin.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SENSORS_ODOMETRY_MODEL_H_
#define CARTOGRAPHER_EXT_SIMULATION_SENSORS_ODOMETRY_MODEL_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

// A time interval in which odometry differs from the noisy distance of the
// wheels over the ground.
struct FaultLabel {
  OdometryFault::Kind kind = OdometryFault::Kind::kSlip;
  double start = 0.;  // stamps of the messages, seconds
  double end = 0.;
  double distance = 0.;  // metres of error over the span
  double angle = 0.;     // radians of error over the span
};

struct OdometryRun {
  std::vector<io::OdometryReading> readings;
  std::vector<FaultLabel> labels;
  // The random parameters of this run.
  double scale_left = 0.;
  double scale_right = 0.;
  double believed_wheel_base = 0.;
};

// `faults` replaces the world's own list.
OdometryRun SimulateOdometry(const World& world, const Drive& drive,
                             const std::vector<OdometryFault>& faults,
                             uint64_t seed);

// Random faults from a short description, comma separated:
//   stale:3    three bursts of 0.3 to 1 s while driving
//   jump:2     two jumps of 0.5 to 1 m, up to 20 degrees
//   slip:4     four slips of 1 to 3 s, wheels 30 to 100 % too fast
//   reverse    backwards reported as forwards, from the start
//   offset:0.12  laser and odometry clocks 0.12 s apart
// Times depend on the seed and lie at least 10 s apart.
absl::StatusOr<std::vector<OdometryFault>> RandomFaults(
    const std::string& description, const Drive& drive, uint64_t seed);

// So many stalls of 0.4 to 1 s while driving or turning, as far apart, depending on
// the seed.
absl::StatusOr<std::vector<ScanStall>> RandomStalls(int count,
                                                    const Drive& drive,
                                                    uint64_t seed);

// An error where the description has another form.
absl::Status CheckRandomFaults(const std::string& description);

const char* FaultName(OdometryFault::Kind kind);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SENSORS_ODOMETRY_MODEL_H_
