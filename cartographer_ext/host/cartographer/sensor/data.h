// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_SENSOR_DATA_H_
#define CARTOGRAPHER_SENSOR_DATA_H_

#include <string>

#include "cartographer/common/time.h"

namespace cartographer {
namespace mapping {
class TrajectoryBuilderInterface;
}  // namespace mapping
}  // namespace cartographer

namespace cartographer {
namespace sensor {

// A reading of any sensor, before it reaches a trajectory builder.
class Data {
 public:
  explicit Data(const std::string& sensor_id) : sensor_id_(sensor_id) {}
  virtual ~Data() {}

  virtual common::Time GetTime() const = 0;
  const std::string& GetSensorId() const { return sensor_id_; }
  virtual void AddToTrajectoryBuilder(
      mapping::TrajectoryBuilderInterface* trajectory_builder) = 0;

 protected:
  const std::string sensor_id_;
};

}  // namespace sensor
}  // namespace cartographer

#endif  // CARTOGRAPHER_SENSOR_DATA_H_
