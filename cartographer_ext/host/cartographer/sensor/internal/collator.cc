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
  for (const std::string& sensor_id : expected_sensor_ids) {
    const QueueKey key{trajectory_id, sensor_id};
    queue_.AddQueue(key, [callback, sensor_id](std::unique_ptr<Data> data) {
      callback(sensor_id, std::move(data));
    });
    queue_keys_[trajectory_id].push_back(key);
  }
}

void Collator::FinishTrajectory(const int trajectory_id) {
  for (const QueueKey& key : queue_keys_[trajectory_id]) {
    queue_.MarkQueueAsFinished(key);
  }
}

void Collator::AddSensorData(const int trajectory_id,
                             std::unique_ptr<Data> data) {
  const QueueKey key{trajectory_id, data->GetSensorId()};
  queue_.Add(key, std::move(data));
}

void Collator::Flush() { queue_.Flush(); }

absl::optional<int> Collator::GetBlockingTrajectoryId() const {
  return queue_.GetBlocker().trajectory_id;
}

}  // namespace sensor
}  // namespace cartographer
