// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A simulated world as a recording: scans, odometry and IMU readings in order
// of their stamps, made as they are asked for. The same world and seed give the
// same readings, bit for bit.
#ifndef CARTOGRAPHER_EXT_SIMULATION_WORLD_SOURCE_H_
#define CARTOGRAPHER_EXT_SIMULATION_WORLD_SOURCE_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/simulation/sensors/imu_model.h"
#include "cartographer_ext/simulation/sensors/laser_model.h"
#include "cartographer_ext/simulation/simulation.h"

namespace cartographer_ext {
namespace simulation {

class WorldSource : public io::SensorSource {
 public:
  explicit WorldSource(std::shared_ptr<const Simulation> simulation);

  const io::SensorSourceInfo& info() const override { return info_; }
  absl::StatusOr<bool> Next(io::SensorEvent* event) override;

  // The truth behind the readings.
  const Simulation& simulation() const { return *simulation_; }

 private:
  const std::shared_ptr<const Simulation> simulation_;
  LaserModel laser_;
  ImuModel imu_;
  io::SensorSourceInfo info_;
  int64_t next_scan_ = 0;
  size_t next_odometry_ = 0;
  int64_t next_imu_ = 0;
};

absl::StatusOr<std::unique_ptr<WorldSource>> OpenWorldWithOptions(
    const std::string& path, const SimulationOptions& options);

// Reads the world file and opens its run with that seed. Errors name the file
// and line, or what is wrong with the drive.
absl::StatusOr<std::unique_ptr<io::SensorSource>> OpenWorld(
    const std::string& path, uint64_t seed);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_WORLD_SOURCE_H_
