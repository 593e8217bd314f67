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

const char* FaultName(OdometryFault::Kind kind);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SENSORS_ODOMETRY_MODEL_H_
