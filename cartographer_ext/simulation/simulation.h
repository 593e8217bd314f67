// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One run of a world with one seed: the drive, the obstacles, the odometry, and
// the times at which scans are taken. Everything random is fixed here; scans
// themselves are made on the fly by WorldSource.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SIMULATION_H_
#define CARTOGRAPHER_EXT_SIMULATION_SIMULATION_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/obstacle_motion.h"
#include "cartographer_ext/simulation/ray_caster.h"
#include "cartographer_ext/simulation/sensors/odometry_model.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

struct SimulationOptions {
  uint64_t seed = 0;
  // Added to the world's own faults; see RandomFaults.
  std::string odometry_faults;
  int scan_stalls = 0;  // likewise; see RandomStalls
  // No noise, bias, dropout, outlier, fault or waypoint jitter at all.
  bool perfect = false;
};

class Simulation {
 public:
  // An error names which waypoint cannot be reached, or where and when the
  // robot would touch a wall or an obstacle.
  static absl::StatusOr<std::unique_ptr<const Simulation>> Create(
      World world, const SimulationOptions& options);

  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const World& world() const { return world_; }
  const SimulationOptions& options() const { return options_; }
  const Drive& drive() const { return drive_; }
  const RayCaster& plan() const { return plan_; }
  const ObstacleMotion& obstacles() const { return obstacles_; }
  const OdometryRun& odometry() const { return odometry_; }

  // Scan i is stamped ScanTime(i) seconds after the start of the drive, and was
  // measured then, or before if the laser had stalled.
  int64_t num_scans() const { return static_cast<int64_t>(scans_.size()); }
  double ScanTime(const int64_t i) const { return scans_[i].stamp; }
  double MeasuredTime(const int64_t i) const { return scans_[i].measured; }
  int64_t num_imu() const { return num_imu_; }
  double ImuTime(int64_t i) const;
  // Nanoseconds of a time counted from the start of the drive.
  io::TimeNs Stamp(double time) const;

 private:
  struct ScanTimes {
    double stamp, measured;  // seconds
  };

  Simulation(World world, const SimulationOptions& options, Drive drive);
  absl::Status CheckCollisions() const;
  void PlanScans(std::vector<ScanStall> stalls);

  const World world_;
  const SimulationOptions options_;
  const Drive drive_;
  const RayCaster plan_;
  const ObstacleMotion obstacles_;
  OdometryRun odometry_;
  std::vector<ScanTimes> scans_;
  int64_t num_imu_ = 0;
};

// The world as it would be with instruments that never err.
World PerfectWorld(World world);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SIMULATION_H_
