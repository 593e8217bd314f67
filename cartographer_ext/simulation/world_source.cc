// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_source.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/simulation/world_parser.h"

namespace cartographer_ext {
namespace simulation {

WorldSource::WorldSource(std::shared_ptr<const Simulation> simulation)
    : simulation_(std::move(simulation)),
      laser_(simulation_->world().laser, &simulation_->plan(),
             &simulation_->obstacles(), simulation_->options().seed),
      imu_(simulation_->world().imu, simulation_->options().seed) {
  info_.format = "world";
  info_.num_scans = simulation_->num_scans();
  info_.num_odometry = simulation_->odometry().readings.size();
  info_.num_imu = simulation_->num_imu();
  info_.begin = simulation_->Stamp(0.);
  info_.end = simulation_->Stamp(simulation_->drive().duration());
}

absl::StatusOr<bool> WorldSource::Next(io::SensorEvent* event) {
  constexpr io::TimeNs kNever = std::numeric_limits<io::TimeNs>::max();
  const Simulation& simulation = *simulation_;
  const auto& odometry = simulation.odometry().readings;
  const io::TimeNs odometry_time =
      next_odometry_ < odometry.size() ? odometry[next_odometry_].time : kNever;
  const io::TimeNs imu_time =
      next_imu_ < simulation.num_imu()
          ? simulation.Stamp(simulation.ImuTime(next_imu_))
          : kNever;
  const io::TimeNs scan_time =
      next_scan_ < simulation.num_scans()
          ? simulation.Stamp(simulation.ScanTime(next_scan_))
          : kNever;
  const io::TimeNs first = std::min({odometry_time, imu_time, scan_time});
  if (first == kNever) return false;
  if (odometry_time == first) {
    *event = odometry[next_odometry_++];
  } else if (imu_time == first) {
    io::ImuReading reading =
        imu_.Sample(simulation.drive().At(simulation.ImuTime(next_imu_)));
    reading.time = imu_time;
    *event = reading;
    ++next_imu_;
  } else {
    io::LaserScan scan =
        laser_.Scan(simulation.drive(), simulation.MeasuredTime(next_scan_));
    scan.time = scan_time;
    *event = std::move(scan);
    ++next_scan_;
  }
  return true;
}

absl::StatusOr<std::unique_ptr<WorldSource>> OpenWorldWithOptions(
    const std::string& path, const SimulationOptions& options) {
  absl::StatusOr<World> world = LoadWorld(path);
  if (!world.ok()) return world.status();
  absl::StatusOr<std::unique_ptr<const Simulation>> simulation =
      Simulation::Create(*std::move(world), options);
  if (!simulation.ok()) {
    return absl::Status(
        simulation.status().code(),
        absl::StrCat(path, ": ", simulation.status().message()));
  }
  return absl::make_unique<WorldSource>(*std::move(simulation));
}

absl::StatusOr<std::unique_ptr<io::SensorSource>> OpenWorld(
    const std::string& path, const uint64_t seed) {
  SimulationOptions options;
  options.seed = seed;
  absl::StatusOr<std::unique_ptr<WorldSource>> source =
      OpenWorldWithOptions(path, options);
  if (!source.ok()) return source.status();
  return std::unique_ptr<io::SensorSource>(*std::move(source));
}

}  // namespace simulation
}  // namespace cartographer_ext
