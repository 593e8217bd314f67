// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Feeds the readings of a recording to one trajectory builder.
#ifndef CARTOGRAPHER_EXT_SLAM_SENSOR_FEEDER_H_
#define CARTOGRAPHER_EXT_SLAM_SENSOR_FEEDER_H_

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cartographer/common/time.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/imu_levelling.h"
#include "cartographer_ext/io/odometry_jumps.h"
#include "cartographer_ext/io/sensor_source.h"

namespace cartographer_ext {
namespace evaluation {

// Counts of fed and skipped readings.
struct FedReadings {
  int64_t scans = 0;
  int64_t odometry_readings = 0;
  int64_t imu_readings = 0;
  // Without a valid range, or not later than the previous scan.
  int64_t skipped_scans = 0;
  // Odometry and IMU readings not later than the previous one.
  int64_t skipped_readings = 0;
  io::OdometryJumps odometry_jumps;  // removed from the odometry
  double sensor_seconds = 0.;        // first to last scan
};

// One line per warning about the readings.
std::vector<std::string> WarningsOf(const FedReadings& fed,
                                    bool wants_odometry);

// A visitor of sensor events.
class SensorFeeder {
 public:
  using TrajectoryBuilder = cartographer::mapping::TrajectoryBuilderInterface;

  // The sensors for which the builder must be created. `lasers`: names of the
  // scan sensors; empty if the recording does not name them.
  static std::set<TrajectoryBuilder::SensorId> Sensors(
      const std::vector<std::string>& lasers, bool use_odometry, bool use_imu);

  // `settings` limits the ranges. Counts into `fed`.
  SensorFeeder(const SensorSettings& settings,
               const std::set<TrajectoryBuilder::SensorId>& sensors,
               TrajectoryBuilder* builder, FedReadings* fed);

  void operator()(const io::LaserScan& scan);
  void operator()(const io::OdometryReading& reading);
  void operator()(const io::ImuReading& reading);

 private:
  const SensorSettings settings_;
  const bool use_odometry_;
  const bool use_imu_;
  TrajectoryBuilder* const builder_;
  FedReadings* const fed_;
  io::ImuLevelling levelling_;  // with use_recorded_imu
  io::TimeNs first_scan_ = 0;
  // By sensor.
  std::map<std::string, cartographer::common::Time> last_scans_;
  cartographer::common::Time last_odometry_ = cartographer::common::Time::min();
  cartographer::common::Time last_imu_ = cartographer::common::Time::min();
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_SENSOR_FEEDER_H_
