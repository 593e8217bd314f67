// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/collated_trajectory_builder.h"

#include <utility>

#include "absl/container/flat_hash_set.h"
#include "cartographer/sensor/internal/dispatchable.h"

namespace cartographer {
namespace mapping {

namespace {

using SensorType = CollatedTrajectoryBuilder::SensorId::SensorType;

std::set<SensorType> BypassingTypes(
    const proto::TrajectoryBuilderOptions& options) {
  std::set<SensorType> types;
  if (!options.collate_fixed_frame())
    types.insert(SensorType::FIXED_FRAME_POSE);
  if (!options.collate_landmarks()) types.insert(SensorType::LANDMARK);
  return types;
}

}  // namespace

CollatedTrajectoryBuilder::CollatedTrajectoryBuilder(
    const proto::TrajectoryBuilderOptions& trajectory_options,
    sensor::CollatorInterface* const sensor_collator, const int trajectory_id,
    const std::set<SensorId>& expected_sensor_ids,
    std::unique_ptr<TrajectoryBuilderInterface> wrapped_trajectory_builder)
    : bypassing_types_(BypassingTypes(trajectory_options)),
      trajectory_id_(trajectory_id),
      collator_(sensor_collator),
      wrapped_(std::move(wrapped_trajectory_builder)) {
  absl::flat_hash_set<std::string> ids;
  for (const SensorId& sensor_id : expected_sensor_ids) {
    if (bypassing_types_.count(sensor_id.type) == 0) ids.insert(sensor_id.id);
  }
  const auto pass_on = [builder = wrapped_.get()](
                           const std::string& /*sensor_id*/,
                           std::unique_ptr<sensor::Data> data) {
    data->AddToTrajectoryBuilder(builder);
  };
  collator_->AddTrajectory(trajectory_id_, ids, pass_on);
}

template <typename Reading>
void CollatedTrajectoryBuilder::Route(const SensorType type,
                                      const std::string& sensor_id,
                                      const Reading& reading) {
  if (bypassing_types_.count(type) > 0) {
    wrapped_->AddSensorData(sensor_id, reading);
  } else {
    collator_->AddSensorData(trajectory_id_,
                             sensor::MakeDispatchable(sensor_id, reading));
  }
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id, const sensor::TimedPointCloudData& scan) {
  Route(SensorType::RANGE, sensor_id, scan);
}

void CollatedTrajectoryBuilder::AddSensorData(const std::string& sensor_id,
                                              const sensor::ImuData& imu_data) {
  Route(SensorType::IMU, sensor_id, imu_data);
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id, const sensor::OdometryData& odometry_data) {
  Route(SensorType::ODOMETRY, sensor_id, odometry_data);
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id,
    const sensor::FixedFramePoseData& fixed_frame_pose_data) {
  Route(SensorType::FIXED_FRAME_POSE, sensor_id, fixed_frame_pose_data);
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id, const sensor::LandmarkData& landmark_data) {
  Route(SensorType::LANDMARK, sensor_id, landmark_data);
}

void CollatedTrajectoryBuilder::AddLocalSlamResultData(
    std::unique_ptr<LocalSlamResultData> local_slam_result_data) {
  collator_->AddSensorData(trajectory_id_, std::move(local_slam_result_data));
}

}  // namespace mapping
}  // namespace cartographer
