// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/sensor_feeder.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/slam/scan_conversion.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using SensorId = SensorFeeder::TrajectoryBuilder::SensorId;

constexpr char kScanId[] = "scan";
constexpr char kOdometryId[] = "odom";
constexpr char kImuId[] = "imu";

SensorId OdometrySensor() {
  return {SensorId::SensorType::ODOMETRY, kOdometryId};
}

SensorId ImuSensor() { return {SensorId::SensorType::IMU, kImuId}; }

// Compared in ticks of the host's clock, which are coarser than those of the
// source.
bool IsLater(const io::TimeNs time, cartographer::common::Time* const last) {
  const cartographer::common::Time host_time = ToHostTime(time);
  if (host_time <= *last) return false;
  *last = host_time;
  return true;
}

}  // namespace

std::vector<std::string> WarningsOf(const FedReadings& fed,
                                    const bool wants_odometry) {
  std::vector<std::string> warnings;
  if (wants_odometry && fed.odometry_readings == 0) {
    warnings.push_back(
        "no odometry: corridors may come out too short or too long, and loop "
        "searches are wider");
  }
  if (fed.skipped_scans > 0) {
    warnings.push_back(absl::StrCat(
        fed.skipped_scans,
        " scans skipped: no valid range, or not later than the previous one"));
  }
  if (fed.skipped_readings > 0) {
    warnings.push_back(absl::StrCat(
        fed.skipped_readings,
        " odometry and IMU readings skipped: not later than the previous one"));
  }
  const io::OdometryJumps& jumps = fed.odometry_jumps;
  if (jumps.count() > 0) {
    warnings.push_back(
        absl::StrFormat("the odometry jumps %d times, first by %.1f m at %.3f "
                        "s; this is implausible, so these steps are ignored",
                        jumps.count(), jumps.first_distance(),
                        io::ToSeconds(jumps.first_time())));
  }
  return warnings;
}

std::set<SensorId> SensorFeeder::Sensors(const std::vector<std::string>& lasers,
                                         const bool use_odometry,
                                         const bool use_imu) {
  std::set<SensorId> sensors;
  for (const std::string& laser : lasers) {
    sensors.insert({SensorId::SensorType::RANGE, laser});
  }
  if (lasers.empty()) sensors.insert({SensorId::SensorType::RANGE, kScanId});
  if (use_odometry) sensors.insert(OdometrySensor());
  if (use_imu) sensors.insert(ImuSensor());
  return sensors;
}

SensorFeeder::SensorFeeder(const SensorSettings& settings,
                           const std::set<SensorId>& sensors,
                           TrajectoryBuilder* const builder,
                           FedReadings* const fed)
    : settings_(settings),
      use_odometry_(sensors.count(OdometrySensor()) > 0),
      use_imu_(sensors.count(ImuSensor()) > 0),
      builder_(builder),
      fed_(fed) {
  for (const SensorId& sensor : sensors) {
    if (sensor.type != SensorId::SensorType::RANGE) continue;
    last_scans_[sensor.id] = cartographer::common::Time::min();
  }
}

void SensorFeeder::operator()(const io::LaserScan& scan) {
  const auto data =
      ToTimedPointCloudData(scan, settings_.min_range, settings_.max_range);
  const std::string id =
      last_scans_.count(scan.sensor_id) > 0 ? scan.sensor_id : kScanId;
  if (data.ranges.empty() || !IsLater(scan.time, &last_scans_.at(id))) {
    ++fed_->skipped_scans;
    return;
  }
  if (fed_->scans == 0) first_scan_ = scan.time;
  ++fed_->scans;
  fed_->sensor_seconds = io::ToSeconds(scan.time - first_scan_);
  builder_->AddSensorData(id, data);
}

void SensorFeeder::operator()(const io::OdometryReading& reading) {
  if (!use_odometry_) return;
  if (!IsLater(reading.time, &last_odometry_)) {
    ++fed_->skipped_readings;
    return;
  }
  ++fed_->odometry_readings;
  builder_->AddSensorData(
      kOdometryId,
      cartographer::sensor::OdometryData{
          ToHostTime(reading.time),
          ToHostPose(fed_->odometry_jumps.Remove(reading.time, reading.pose))});
}

void SensorFeeder::operator()(const io::ImuReading& reading) {
  if (!use_imu_) return;
  if (!IsLater(reading.time, &last_imu_)) {
    ++fed_->skipped_readings;
    return;
  }
  ++fed_->imu_readings;
  const io::ImuReading used =
      settings_.use_recorded_imu ? levelling_.Level(reading) : reading;
  builder_->AddSensorData(
      kImuId, cartographer::sensor::ImuData{ToHostTime(used.time),
                                            used.linear_acceleration,
                                            used.angular_velocity});
}

}  // namespace evaluation
}  // namespace cartographer_ext
