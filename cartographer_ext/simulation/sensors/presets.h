// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Lasers, robots and grades of odometry by name, with the values of data sheets
// and of common robots. docs/world_format.md lists them.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SENSORS_PRESETS_H_
#define CARTOGRAPHER_EXT_SIMULATION_SENSORS_PRESETS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

// depth_camera, rplidar_a1, ld06, urg_04lx, utm_30lx, sick_lms
const std::vector<std::string>& LaserPresetNames();
// differential, mecanum, car
const std::vector<std::string>& RobotPresetNames();
// good, fair, poor, none
const std::vector<std::string>& OdometryPresetNames();

// Errors of the three list the valid names.

// The laser by that name, mounted at the robot's origin.
absl::StatusOr<LaserSettings> LaserPreset(const std::string& name);

// The robot by that name with its encoders, without errors.
struct RobotPresetSettings {
  RobotSettings robot;
  OdometrySettings odometry;
};
absl::StatusOr<RobotPresetSettings> RobotPreset(const std::string& name);

// Gives the world's odometry, whose geometry and message rate stay, the errors
// of that grade. Slips of `poor` lie at times that depend on drive and seed.
absl::Status ApplyOdometryPreset(const std::string& name, uint64_t seed,
                                 World* world);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SENSORS_PRESETS_H_
