// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_ext/io/ros/scan_timing.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/order_statistics.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxScans = 1000;
constexpr size_t kMinScans = 10;
constexpr size_t kMaxSensors = 64;
// Tolerance for the jitter of stamps, relative to the period.
constexpr double kPeriodTolerance = 1.1;
// Below, a walking robot moves less than the cells of its map within a scan.
constexpr double kSlowPeriod = 0.05;
constexpr double kTurningFieldOfView = 1.5 * kPi;

// 0 for too few values.
double Median(const std::vector<double>& values) {
  return values.size() < kMinScans ? 0. : UpperMedian(values);
}

std::string Seconds(const double value) {
  return absl::StrFormat("%.3g s", value);
}

}  // namespace

void ScanTiming::Add(const std::string& topic, const std::string& frame,
                     const TimeNs begin, const double sweep,
                     const double field_of_view) {
  const auto key = std::make_pair(topic, frame);
  if (sensors_.size() >= kMaxSensors && sensors_.count(key) == 0) return;
  Sensor& sensor = sensors_[key];
  sensor.field_of_view = std::max(sensor.field_of_view, field_of_view);
  if (sensor.any && begin > sensor.last && sensor.periods.size() < kMaxScans) {
    sensor.periods.push_back(ToSeconds(begin - sensor.last));
    sensor.sweeps.push_back(sweep);
  }
  sensor.any = true;
  sensor.last = begin;
}

void ScanTiming::Judge() {
  for (auto& entry : sensors_) {
    Sensor& sensor = entry.second;
    sensor.period = Median(sensor.periods);
    sensor.sweep = Median(sensor.sweeps);
    sensor.impossible =
        sensor.period > 0. && sensor.sweep > kPeriodTolerance * sensor.period;
  }
}

bool ScanTiming::IsImpossible(const std::string& topic,
                              const std::string& frame) const {
  const auto found = sensors_.find(std::make_pair(topic, frame));
  return found != sensors_.end() && found->second.impossible;
}

bool ScanTiming::AnyImpossible() const {
  return std::any_of(sensors_.begin(), sensors_.end(),
                     [](const auto& entry) { return entry.second.impossible; });
}

std::vector<std::string> ScanTiming::Warnings() const {
  std::vector<std::string> warnings;
  for (const auto& entry : sensors_) {
    const Sensor& sensor = entry.second;
    if (sensor.impossible) {
      warnings.push_back(absl::StrCat(
          "the times of beams on ", entry.first.first, " make a scan take ",
          Seconds(sensor.sweep), ", but one comes every ",
          Seconds(sensor.period), "; scans are treated as instantaneous"));
    } else if (sensor.sweep == 0. && sensor.period >= kSlowPeriod &&
               sensor.field_of_view >= kTurningFieldOfView) {
      warnings.push_back(absl::StrCat(
          "no times of beams on ", entry.first.first,
          " (time_increment is 0): every scan is taken as measured at ",
          "once, unless turns of the robot show that the laser turns once a ",
          "scan; then beams are up to ", Seconds(sensor.period),
          " old, and the scans before are smeared"));
    }
  }
  return warnings;
}

}  // namespace io
}  // namespace cartographer_ext
