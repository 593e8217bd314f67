// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/collated_trajectory_builder.h"

#include <utility>

#include "absl/container/flat_hash_set.h"
#include "cartographer/sensor/internal/dispatchable.h"

namespace cartographer {
namespace mapping {

CollatedTrajectoryBuilder::CollatedTrajectoryBuilder(
    const proto::TrajectoryBuilderOptions& trajectory_options,
    sensor::CollatorInterface* const sensor_collator, const int trajectory_id,
    const std::set<SensorId>& expected_sensor_ids,
    std::unique_ptr<TrajectoryBuilderInterface> wrapped_trajectory_builder)
    : sensor_collator_(sensor_collator),
      collate_landmarks_(trajectory_options.collate_landmarks()),
      collate_fixed_frame_(trajectory_options.collate_fixed_frame()),
      trajectory_id_(trajectory_id),
      wrapped_trajectory_builder_(std::move(wrapped_trajectory_builder)) {
  absl::flat_hash_set<std::string> collated_ids;
  for (const SensorId& sensor_id : expected_sensor_ids) {
    if (IsCollated(sensor_id.type)) {
      collated_ids.insert(sensor_id.id);
    }
  }
  TrajectoryBuilderInterface* const wrapped = wrapped_trajectory_builder_.get();
  sensor_collator_->AddTrajectory(
      trajectory_id, collated_ids,
      [wrapped](const std::string& /*sensor_id*/,
                std::unique_ptr<sensor::Data> data) {
        data->AddToTrajectoryBuilder(wrapped);
      });
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id,
    const sensor::TimedPointCloudData& timed_point_cloud_data) {
  Collate(sensor::MakeDispatchable(sensor_id, timed_point_cloud_data));
}

void CollatedTrajectoryBuilder::AddSensorData(const std::string& sensor_id,
                                              const sensor::ImuData& imu_data) {
  Collate(sensor::MakeDispatchable(sensor_id, imu_data));
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id, const sensor::OdometryData& odometry_data) {
  Collate(sensor::MakeDispatchable(sensor_id, odometry_data));
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id,
    const sensor::FixedFramePoseData& fixed_frame_pose_data) {
  if (collate_fixed_frame_) {
    Collate(sensor::MakeDispatchable(sensor_id, fixed_frame_pose_data));
  } else {
    wrapped_trajectory_builder_->AddSensorData(sensor_id,
                                               fixed_frame_pose_data);
  }
}

void CollatedTrajectoryBuilder::AddSensorData(
    const std::string& sensor_id, const sensor::LandmarkData& landmark_data) {
  if (collate_landmarks_) {
    Collate(sensor::MakeDispatchable(sensor_id, landmark_data));
  } else {
    wrapped_trajectory_builder_->AddSensorData(sensor_id, landmark_data);
  }
}

void CollatedTrajectoryBuilder::AddLocalSlamResultData(
    std::unique_ptr<mapping::LocalSlamResultData> local_slam_result_data) {
  Collate(std::move(local_slam_result_data));
}

bool CollatedTrajectoryBuilder::IsCollated(
    const SensorId::SensorType type) const {
  switch (type) {
    case SensorId::SensorType::LANDMARK:
      return collate_landmarks_;
    case SensorId::SensorType::FIXED_FRAME_POSE:
      return collate_fixed_frame_;
    default:
      return true;
  }
}

void CollatedTrajectoryBuilder::Collate(std::unique_ptr<sensor::Data> data) {
  sensor_collator_->AddSensorData(trajectory_id_, std::move(data));
}

}  // namespace mapping
}  // namespace cartographer
