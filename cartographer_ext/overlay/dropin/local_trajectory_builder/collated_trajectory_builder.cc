// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/collated_trajectory_builder.h"

#include <utility>

#include "cartographer_ext/options/extension_field.h"
#include "glog/logging.h"

#ifndef CARTOGRAPHER_EXT_OVERLAY_COLLATED_TRAJECTORY_BUILDER_H_
#error \
    "The overlay of cartographer_ext is not first on the include path: another package puts Cartographer's sources before it."
#endif

namespace cartographer {
namespace mapping {

CollatedTrajectoryBuilder::CollatedTrajectoryBuilder(
    const proto::TrajectoryBuilderOptions& trajectory_options,
    sensor::CollatorInterface* const sensor_collator, const int trajectory_id,
    const std::set<SensorId>& expected_sensor_ids,
    std::unique_ptr<TrajectoryBuilderInterface> wrapped_trajectory_builder)
    : StockCollatedTrajectoryBuilder(trajectory_options, sensor_collator,
                                     trajectory_id, expected_sensor_ids,
                                     std::move(wrapped_trajectory_builder)),
      drops_(::cartographer_ext::options::HasExtension(
          trajectory_options.trajectory_builder_2d_options())) {}

CollatedTrajectoryBuilder::~CollatedTrajectoryBuilder() {
  for (const auto& entry : stamps_) {
    LOG_IF(WARNING, entry.second.num_dropped > 0)
        << "cartographer_ext: " << entry.second.num_dropped
        << " readings of sensor \"" << entry.first
        << "\" dropped: not later than the one before";
  }
}

bool CollatedTrajectoryBuilder::IsLater(const std::string& sensor_id,
                                        const common::Time time) {
  Stamps& stamps = stamps_[sensor_id];
  if (time > stamps.last) {
    stamps.last = time;
    return true;
  }
  LOG_IF(WARNING, stamps.num_dropped == 0)
      << "cartographer_ext: a reading of sensor \"" << sensor_id
      << "\" is dropped: its stamp " << time << " is not later than "
      << stamps.last << " of the one before; further ones are counted";
  ++stamps.num_dropped;
  return false;
}

void CollatedTrajectoryBuilder::AddSensorData(const std::string& sensor_id,
                                              const sensor::ImuData& imu_data) {
  if (drops_ && !IsLater(sensor_id, imu_data.time)) return;
  StockCollatedTrajectoryBuilder::AddSensorData(sensor_id, imu_data);
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id, const sensor::OdometryData& odometry_data) {
  if (drops_ && !IsLater(sensor_id, odometry_data.time)) return;
  StockCollatedTrajectoryBuilder::AddSensorData(sensor_id, odometry_data);
}

}  // namespace mapping
}  // namespace cartographer
