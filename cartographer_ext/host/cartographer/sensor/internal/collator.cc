// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/collator.h"

#include <utility>

namespace cartographer {
namespace sensor {

void Collator::AddTrajectory(
    const int trajectory_id,
    const absl::flat_hash_set<std::string>& expected_sensor_ids,
    const Callback& callback) {
  AddQueues(trajectory_id, expected_sensor_ids, callback, &queue_);
}

void Collator::FinishTrajectory(const int trajectory_id) {
  queue_.FinishTrajectory(trajectory_id);
}

void Collator::AddSensorData(const int trajectory_id,
                             std::unique_ptr<Data> data) {
  const std::string sensor_id = data->GetSensorId();
  queue_.Add(QueueKey{trajectory_id, sensor_id}, std::move(data));
}

void Collator::Flush() { queue_.Flush(); }

absl::optional<int> Collator::GetBlockingTrajectoryId() const {
  return queue_.GetBlocker().trajectory_id;
}

}  // namespace sensor
}  // namespace cartographer
