// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/ros/no_return_code.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr size_t kMaxSensors = 64;
constexpr size_t kMaxScans = 1000000;
constexpr size_t kMaxCandidates = 64;
constexpr float kMinCode = 1.f;  // metres; closer it may be the robot itself
// Of a scan with the code.
constexpr double kMinBeamShare = 0.05;
constexpr int64_t kMinBeams = 5;
// Were all beams alike, nothing would be left.
constexpr double kMaxReturnShare = 0.95;
constexpr float kNear = 0.05f;  // metres below the code
constexpr int64_t kMinPeak = 4;
// Of a recording.
constexpr int64_t kMinScans = 20;
constexpr double kMinScanShare = 0.2;
constexpr double kMaxFartherShare = 0.01;

}  // namespace

void NoReturnCodes::Add(const std::string& topic, const std::string& frame,
                        const LaserScan& scan) {
  const auto key = std::make_pair(topic, frame);
  if (sensors_.size() >= kMaxSensors && sensors_.count(key) == 0) return;
  Sensor& sensor = sensors_[key];
  if (sensor.largest.size() >= kMaxScans) return;
  // False for what is no number.
  const auto is_return = [&](const float range) {
    return range > 0.f && range >= scan.range_min && range <= scan.range_max;
  };
  float largest = 0.f;
  for (const float range : scan.ranges) {
    if (is_return(range)) largest = std::max(largest, range);
  }
  if (largest <= 0.f) return;
  sensor.largest.push_back(largest);
  int64_t num_equal = 0, num_near = 0, num_returns = 0;
  for (const float range : scan.ranges) {
    if (!is_return(range)) continue;
    ++num_returns;
    num_equal += range == largest;
    num_near += range < largest && range > largest - kNear;
  }
  const double num_beams = static_cast<double>(scan.ranges.size());
  if (largest < kMinCode || num_equal < kMinBeams ||
      num_equal < kMinBeamShare * num_beams ||
      num_equal > kMaxReturnShare * static_cast<double>(num_returns) ||
      num_equal < kMinPeak * num_near) {
    return;
  }
  if (sensor.candidates.size() >= kMaxCandidates &&
      sensor.candidates.count(largest) == 0) {
    return;
  }
  Candidate& candidate = sensor.candidates[largest];
  ++candidate.num_scans;
  candidate.num_beams += num_equal;
  candidate.num_all_beams += static_cast<int64_t>(scan.ranges.size());
}

void NoReturnCodes::Judge() {
  for (auto& entry : sensors_) {
    Sensor& sensor = entry.second;
    sensor.code = 0.f;
    const auto best =
        std::max_element(sensor.candidates.begin(), sensor.candidates.end(),
                         [](const auto& a, const auto& b) {
                           return a.second.num_scans < b.second.num_scans;
                         });
    if (best == sensor.candidates.end()) continue;
    const double num_scans = static_cast<double>(sensor.largest.size());
    const auto num_farther =
        std::count_if(sensor.largest.begin(), sensor.largest.end(),
                      [&](const float range) { return range > best->first; });
    if (best->second.num_scans < kMinScans ||
        best->second.num_scans < kMinScanShare * num_scans ||
        num_farther > kMaxFartherShare * num_scans) {
      continue;
    }
    sensor.code = best->first;
  }
}

double NoReturnCodes::RangeMax(const std::string& topic,
                               const std::string& frame) const {
  const auto found = sensors_.find(std::make_pair(topic, frame));
  if (found == sensors_.end() || found->second.code <= 0.f) {
    return std::numeric_limits<double>::infinity();
  }
  return std::nextafter(found->second.code, 0.f);
}

std::vector<std::string> NoReturnCodes::Warnings() const {
  std::vector<std::string> warnings;
  for (const auto& entry : sensors_) {
    const Sensor& sensor = entry.second;
    if (sensor.code <= 0.f) continue;
    const Candidate& found = sensor.candidates.at(sensor.code);
    warnings.push_back(absl::StrFormat(
        "%d %% of the beams on %s read exactly %.6g m in %d of %d scans, and "
        "nothing is farther away: taken for no return",
        std::lround(100. * static_cast<double>(found.num_beams) /
                    static_cast<double>(found.num_all_beams)),
        entry.first.first, sensor.code, found.num_scans,
        sensor.largest.size()));
  }
  return warnings;
}

}  // namespace io
}  // namespace cartographer_ext
