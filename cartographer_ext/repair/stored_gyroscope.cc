// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/stored_gyroscope.h"

#include <algorithm>
#include <cmath>

#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/imu_levelling.h"

namespace cartographer_ext {
namespace repair {
namespace {

using cartographer::common::Time;
using cartographer::sensor::ImuData;

// An alignment that turns by less than this between any two nodes in a row holds
// no rotation, radians; nodes are inserted after a degree.
constexpr double kLeastRotation = 0.01;
// Readings are so far apart at most, seconds.
constexpr double kReadingInterval = 0.05;
// Unless a node follows after more than a minute: a robot that was switched off
// for long, or a damaged stamp.
constexpr int64_t kMaxReadings = 1200;

// Rotation of the gravity alignment about the vertical axis, radians, by time.
using Yaws = std::map<Time, double>;

bool UsedImu(const io::Pbstream& pbstream, const int trajectory_id) {
  const auto& options = pbstream.options.options_with_sensor_ids();
  return trajectory_id >= 0 && trajectory_id < options.size() &&
         options.Get(trajectory_id)
             .trajectory_builder_options()
             .trajectory_builder_2d_options()
             .use_imu_data();
}

std::vector<ImuData> Readings(const Yaws& yaws) {
  std::vector<ImuData> readings;
  double largest = 0.;
  for (auto to = yaws.begin(), from = to; to != yaws.end(); from = to++) {
    if (to == from) continue;
    const double seconds =
        cartographer::common::ToSeconds(to->first - from->first);
    const double angle = NormalizeAngle(to->second - from->second);
    largest = std::max(largest, std::abs(angle));
    const Eigen::Vector3d rate = angle / seconds * Eigen::Vector3d::UnitZ();
    const auto steps = static_cast<int64_t>(
        std::min(std::ceil(seconds / kReadingInterval), 1. * kMaxReadings));
    const Time::duration step = (to->first - from->first) / steps;
    const Time::duration rest = (to->first - from->first) % steps;
    for (int64_t i = 0; i <= steps; ++i) {
      // The rate changes at the node: a tick after it, the new one.
      const Time time = i == 0 ? from->first + Time::duration(1)
                               : from->first + i * step + i * rest / steps;
      if (!readings.empty() && time <= readings.back().time) continue;
      readings.push_back({time, io::kGravity * Eigen::Vector3d::UnitZ(), rate});
    }
  }
  if (largest < kLeastRotation) return {};
  // Local SLAM waits for a reading before the first node.
  readings.insert(readings.begin(), readings.front());
  readings.front().time = yaws.begin()->first;
  return readings;
}

}  // namespace

std::map<int, std::vector<ImuData>> StoredGyroscopeReadings(
    const io::Pbstream& pbstream) {
  std::map<int, Yaws> yaws;
  for (const auto& record : pbstream.nodes) {
    const int trajectory_id = record.node_id().trajectory_id();
    if (!UsedImu(pbstream, trajectory_id)) continue;
    const auto& data = record.node_data();
    const Time time = cartographer::common::FromUniversal(data.timestamp());
    yaws[trajectory_id][time] = cartographer::transform::GetYaw(
        cartographer::transform::ToEigen(data.gravity_alignment()));
  }
  std::map<int, std::vector<ImuData>> result;
  for (const auto& entry : yaws) {
    std::vector<ImuData> readings = Readings(entry.second);
    if (!readings.empty()) result[entry.first] = std::move(readings);
  }
  return result;
}

}  // namespace repair
}  // namespace cartographer_ext
