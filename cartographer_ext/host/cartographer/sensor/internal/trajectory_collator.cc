// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/sensor/internal/trajectory_collator.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "glog/logging.h"

namespace cartographer {
namespace sensor {

metrics::Family<metrics::Counter>*
    TrajectoryCollator::collator_metrics_family_ =
        metrics::Family<metrics::Counter>::Null();

void TrajectoryCollator::AddTrajectory(
    const int trajectory_id,
    const absl::flat_hash_set<std::string>& expected_sensor_ids,
    const Callback& callback) {
  CHECK_EQ(trajectories_.count(trajectory_id), 0)
      << "trajectory " << trajectory_id << " exists";
  AddQueues(trajectory_id, expected_sensor_ids, callback,
            &trajectories_[trajectory_id].queue);
}

void TrajectoryCollator::FinishTrajectory(const int trajectory_id) {
  trajectories_.at(trajectory_id).queue.FinishTrajectory(trajectory_id);
}

void TrajectoryCollator::AddSensorData(const int trajectory_id,
                                       std::unique_ptr<Data> data) {
  const auto found = trajectories_.find(trajectory_id);
  CHECK(found != trajectories_.end()) << "no trajectory " << trajectory_id;
  const QueueKey key{trajectory_id, data->GetSensorId()};
  metrics::Counter*& counter = found->second.counters[key.sensor_id];
  if (counter == nullptr) {
    counter = collator_metrics_family_->Add(
        {{"sensor_id", key.sensor_id},
         {"trajectory_id", absl::StrCat(trajectory_id)}});
  }
  counter->Increment();
  found->second.queue.Add(key, std::move(data));
}

void TrajectoryCollator::Flush() {
  for (auto& entry : trajectories_) entry.second.queue.Flush();
}

absl::optional<int> TrajectoryCollator::GetBlockingTrajectoryId() const {
  return absl::nullopt;
}

void TrajectoryCollator::RegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  collator_metrics_family_ = family_factory->NewCounterFamily(
      "collator_input_total", "Sensor readings received");
}

}  // namespace sensor
}  // namespace cartographer
