// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_COLLATOR_INTERFACE_H_
#define CARTOGRAPHER_SENSOR_COLLATOR_INTERFACE_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/types/optional.h"
#include "cartographer/sensor/data.h"

namespace cartographer {
namespace sensor {

// Brings the readings of several sensors into one order of time.
class CollatorInterface {
 public:
  using Callback =
      std::function<void(const std::string&, std::unique_ptr<Data>)>;

  CollatorInterface() {}
  virtual ~CollatorInterface() {}
  CollatorInterface(const CollatorInterface&) = delete;
  CollatorInterface& operator=(const CollatorInterface&) = delete;

  // `callback` gets the readings of these sensors of this trajectory in order.
  virtual void AddTrajectory(
      int trajectory_id,
      const absl::flat_hash_set<std::string>& expected_sensor_ids,
      const Callback& callback) = 0;

  // No more readings of this trajectory will come.
  virtual void FinishTrajectory(int trajectory_id) = 0;

  // Readings of one sensor must come in order of time. Calls back as far as the
  // order is settled.
  virtual void AddSensorData(int trajectory_id, std::unique_ptr<Data> data) = 0;

  // Calls back with everything that is left, in order.
  virtual void Flush() = 0;

  // A trajectory that others wait for; only after AddSensorData.
  virtual absl::optional<int> GetBlockingTrajectoryId() const = 0;
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_COLLATOR_INTERFACE_H_
