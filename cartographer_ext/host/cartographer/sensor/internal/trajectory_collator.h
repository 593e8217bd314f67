// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_INTERNAL_TRAJECTORY_COLLATOR_H_
#define CARTOGRAPHER_SENSOR_INTERNAL_TRAJECTORY_COLLATOR_H_

#include <map>
#include <memory>
#include <string>

#include "absl/container/flat_hash_set.h"
#include "absl/types/optional.h"
#include "cartographer/metrics/counter.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/sensor/collator_interface.h"
#include "cartographer/sensor/internal/ordered_multi_queue.h"

namespace cartographer {
namespace sensor {

// An order of time within each trajectory; trajectories do not wait for each
// other.
class TrajectoryCollator : public CollatorInterface {
 public:
  TrajectoryCollator() {}

  void AddTrajectory(
      int trajectory_id,
      const absl::flat_hash_set<std::string>& expected_sensor_ids,
      const Callback& callback) override;
  void FinishTrajectory(int trajectory_id) override;
  void AddSensorData(int trajectory_id, std::unique_ptr<Data> data) override;
  void Flush() override;
  absl::optional<int> GetBlockingTrajectoryId() const override;

  // Counter collator_input_total{sensor_id, trajectory_id}.
  static void RegisterMetrics(metrics::FamilyFactory* family_factory);

 private:
  struct Trajectory {
    OrderedMultiQueue queue;
    std::map<std::string, metrics::Counter*> counters;
  };

  static metrics::Family<metrics::Counter>* collator_metrics_family_;
  std::map<int, Trajectory> trajectories_;
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_INTERNAL_TRAJECTORY_COLLATOR_H_
