// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/simulation/random_faults.h"

namespace cartographer_ext {
namespace simulation {
namespace {

constexpr double kCollisionStep = 0.05;  // seconds
constexpr double kRounding = 1e-9;       // seconds

}  // namespace

World PerfectWorld(World world) {
  LaserSettings& laser = world.laser;
  laser.noise = laser.proportional_noise = laser.dropout = laser.outlier = 0.;
  laser.resolution = 0.;
  OdometrySettings& odometry = world.odometry;
  odometry.scale_left = odometry.scale_right = odometry.scale_sigma = 0.;
  odometry.mismatch_sigma = odometry.wheel_base_error = 0.;
  odometry.wheel_base_sigma = odometry.noise = odometry.ticks_per_meter = 0.;
  odometry.lateral_noise = 0.;
  ImuSettings& imu = world.imu;
  imu.gyro_noise = imu.gyro_bias_sigma = imu.gyro_bias_walk = 0.;
  imu.accel_noise = imu.accel_bias_sigma = imu.accel_bias_walk = 0.;
  world.robot.jitter = 0.;
  world.faults.clear();
  world.stalls.clear();
  return world;
}

Simulation::Simulation(World world, const SimulationOptions& options,
                       Drive drive)
    : world_(std::move(world)),
      options_(options),
      drive_(std::move(drive)),
      plan_(world_.segments, world_.discs),
      obstacles_(world_.obstacles, options.seed) {}

absl::StatusOr<std::unique_ptr<const Simulation>> Simulation::Create(
    World world, const SimulationOptions& options) {
  if (options.perfect) world = PerfectWorld(std::move(world));
  absl::StatusOr<Drive> drive = Drive::Plan(world, options.seed);
  if (!drive.ok()) return drive.status();
  std::vector<OdometryFault> faults = world.faults;
  std::vector<ScanStall> stalls = world.stalls;
  if (!options.perfect) {
    const absl::StatusOr<std::vector<OdometryFault>> more =
        RandomFaults(options.odometry_faults, *drive, options.seed);
    if (!more.ok()) return more.status();
    faults.insert(faults.end(), more->begin(), more->end());
    const absl::StatusOr<std::vector<ScanStall>> more_stalls =
        RandomStalls(options.scan_stalls, *drive, options.seed);
    if (!more_stalls.ok()) return more_stalls.status();
    stalls.insert(stalls.end(), more_stalls->begin(), more_stalls->end());
  }
  std::unique_ptr<Simulation> simulation(
      new Simulation(std::move(world), options, *std::move(drive)));
  const absl::Status status = simulation->CheckCollisions();
  if (!status.ok()) return status;
  simulation->PlanScans(std::move(stalls));
  const double duration = simulation->drive_.duration() + kRounding;
  if (simulation->world_.imu.present) {
    simulation->num_imu_ =
        static_cast<int64_t>(duration * simulation->world_.imu.rate) + 1;
  }
  simulation->odometry_ = SimulateOdometry(
      simulation->world_, simulation->drive_, faults, options.seed);
  return std::unique_ptr<const Simulation>(std::move(simulation));
}

void Simulation::PlanScans(std::vector<ScanStall> stalls) {
  const LaserSettings& laser = world_.laser;
  const double duration = drive_.duration() + kRounding;
  const auto num_measured = std::max<int64_t>(
      0, static_cast<int64_t>((duration - laser.sweep) * laser.rate) + 1);
  std::sort(
      stalls.begin(), stalls.end(),
      [](const ScanStall& a, const ScanStall& b) { return a.start < b.start; });
  auto next = stalls.begin();
  double stalled_until = 0.;
  bool has_stalled = false;  // at the scan before
  for (int64_t i = 0; i != num_measured; ++i) {
    const double time = laser.sweep + i / laser.rate;
    for (; next != stalls.end() && next->start <= time; ++next) {
      stalled_until = std::max(stalled_until, next->start + next->duration);
    }
    const bool is_stalled = time < stalled_until;
    if (is_stalled && has_stalled) {
      scans_.back().stamp = time;
    } else {
      scans_.push_back({time, time});
    }
    has_stalled = is_stalled;
  }
}

double Simulation::ImuTime(const int64_t i) const {
  return i / world_.imu.rate;
}

io::TimeNs Simulation::Stamp(const double time) const {
  return io::FromSeconds(world_.begin) + io::FromSeconds(time);
}

absl::Status Simulation::CheckCollisions() const {
  const double radius = world_.robot.radius;
  if (radius == 0.) return absl::OkStatus();
  const int64_t steps =
      static_cast<int64_t>(drive_.duration() / kCollisionStep) + 1;
  Eigen::Vector2d before = world_.start.translation();
  for (int64_t i = 0; i <= steps; ++i) {
    const double time = i * kCollisionStep;
    const Eigen::Vector2d position = drive_.PoseAt(time).translation();
    if (plan_.Clearance(position, radius) < radius ||
        !plan_.Visible(before, position)) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "world '%s': the robot (radius %g m) touches a wall at (%.2f, %.2f), "
          "%.1f s after the start",
          world_.name, radius, position.x(), position.y(), time));
    }
    for (size_t j = 0; j != obstacles_.size(); ++j) {
      if ((obstacles_.Position(j, time) - position).norm() <
          radius + obstacles_.radius(j)) {
        return absl::InvalidArgumentError(absl::StrFormat(
            "world '%s', seed %d: the robot (radius %g m) touches obstacle %d "
            "at (%.2f, %.2f), %.1f s after the start",
            world_.name, options_.seed, radius, j + 1, position.x(),
            position.y(), time));
      }
    }
    before = position;
  }
  return absl::OkStatus();
}

}  // namespace simulation
}  // namespace cartographer_ext
