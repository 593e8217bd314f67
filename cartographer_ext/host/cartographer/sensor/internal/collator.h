// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_INTERNAL_COLLATOR_H_
#define CARTOGRAPHER_SENSOR_INTERNAL_COLLATOR_H_

#include <memory>
#include <string>

#include "absl/container/flat_hash_set.h"
#include "absl/types/optional.h"
#include "cartographer/sensor/collator_interface.h"
#include "cartographer/sensor/internal/ordered_multi_queue.h"

namespace cartographer {
namespace sensor {

// One order of time across all trajectories: a trajectory without readings
// holds up the others.
class Collator : public CollatorInterface {
 public:
  Collator() {}

  void AddTrajectory(
      int trajectory_id,
      const absl::flat_hash_set<std::string>& expected_sensor_ids,
      const Callback& callback) override;
  void FinishTrajectory(int trajectory_id) override;
  void AddSensorData(int trajectory_id, std::unique_ptr<Data> data) override;
  void Flush() override;
  absl::optional<int> GetBlockingTrajectoryId() const override;

 private:
  OrderedMultiQueue queue_;
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_INTERNAL_COLLATOR_H_
