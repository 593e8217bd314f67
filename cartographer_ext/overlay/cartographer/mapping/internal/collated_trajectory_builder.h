// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path. The class found there
// becomes StockCollatedTrajectoryBuilder; the class of the original name drops
// readings that would terminate the program, if the options have our block of
// local SLAM.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_LOCAL_TRAJECTORY_BUILDER) || \
    defined(CollatedTrajectoryBuilder)
// Not selected, or this is the stock source with its class renamed.
#include_next "cartographer/mapping/internal/collated_trajectory_builder.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_COLLATED_TRAJECTORY_BUILDER_H_
#define CARTOGRAPHER_EXT_OVERLAY_COLLATED_TRAJECTORY_BUILDER_H_

#define CollatedTrajectoryBuilder StockCollatedTrajectoryBuilder
#include_next "cartographer/mapping/internal/collated_trajectory_builder.h"
#undef CollatedTrajectoryBuilder

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>

namespace cartographer {
namespace mapping {

// Robots do send odometry and IMU readings twice, or with a stamp before the
// last one; the stock collator and pose graph terminate the program in this
// case. With our block of local SLAM a reading that is not later than the
// previous one of the same sensor is dropped, with one warning per sensor and a
// count at the end.
class CollatedTrajectoryBuilder : public StockCollatedTrajectoryBuilder {
 public:
  using SensorId = StockCollatedTrajectoryBuilder::SensorId;
  using StockCollatedTrajectoryBuilder::AddSensorData;

  CollatedTrajectoryBuilder(
      const proto::TrajectoryBuilderOptions& trajectory_options,
      sensor::CollatorInterface* sensor_collator, int trajectory_id,
      const std::set<SensorId>& expected_sensor_ids,
      std::unique_ptr<TrajectoryBuilderInterface> wrapped_trajectory_builder);
  ~CollatedTrajectoryBuilder() override;

  void AddSensorData(const std::string& sensor_id,
                     const sensor::ImuData& imu_data) override;
  void AddSensorData(const std::string& sensor_id,
                     const sensor::OdometryData& odometry_data) override;

 private:
  struct Stamps {
    common::Time last = common::Time::min();
    int64_t num_dropped = 0;
  };
  bool IsLater(const std::string& sensor_id, common::Time time);

  const bool drops_;
  std::map<std::string, Stamps> stamps_;  // by sensor
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_COLLATED_TRAJECTORY_BUILDER_H_
#endif
