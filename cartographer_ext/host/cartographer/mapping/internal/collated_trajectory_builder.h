// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts the data of all sensors of a trajectory in order of time, through the
// collator that all trajectories share, before the wrapped builder sees them.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_COLLATED_TRAJECTORY_BUILDER_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_COLLATED_TRAJECTORY_BUILDER_H_

#include <memory>
#include <set>
#include <string>

#include "cartographer/mapping/internal/local_slam_result_data.h"
#include "cartographer/mapping/trajectory_builder_interface.h"
#include "cartographer/sensor/collator_interface.h"
#include "cartographer/sensor/data.h"

namespace cartographer {
namespace mapping {

class CollatedTrajectoryBuilder : public TrajectoryBuilderInterface {
 public:
  using SensorId = TrajectoryBuilderInterface::SensorId;

  // Landmarks and fixed frame poses take part in the ordering only where the
  // options say so; otherwise they go straight through.
  CollatedTrajectoryBuilder(
      const proto::TrajectoryBuilderOptions& trajectory_options,
      sensor::CollatorInterface* sensor_collator, int trajectory_id,
      const std::set<SensorId>& expected_sensor_ids,
      std::unique_ptr<TrajectoryBuilderInterface> wrapped_trajectory_builder);
  ~CollatedTrajectoryBuilder() override {}
  CollatedTrajectoryBuilder(const CollatedTrajectoryBuilder&) = delete;
  CollatedTrajectoryBuilder& operator=(const CollatedTrajectoryBuilder&) =
      delete;

  void AddSensorData(const std::string& sensor_id,
                     const sensor::TimedPointCloudData& scan) override;
  void AddSensorData(const std::string& sensor_id,
                     const sensor::ImuData& imu_data) override;
  void AddSensorData(const std::string& sensor_id,
                     const sensor::OdometryData& odometry_data) override;
  void AddSensorData(
      const std::string& sensor_id,
      const sensor::FixedFramePoseData& fixed_frame_pose_data) override;
  void AddSensorData(const std::string& sensor_id,
                     const sensor::LandmarkData& landmark_data) override;
  void AddLocalSlamResultData(std::unique_ptr<mapping::LocalSlamResultData>
                                  local_slam_result_data) override;

 private:
  template <typename Reading>
  void Route(SensorId::SensorType type, const std::string& sensor_id,
             const Reading& reading);

  // Not ordered by time with the others.
  const std::set<SensorId::SensorType> bypassing_types_;
  const int trajectory_id_;
  sensor::CollatorInterface* const collator_;
  const std::unique_ptr<TrajectoryBuilderInterface> wrapped_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_COLLATED_TRAJECTORY_BUILDER_H_
