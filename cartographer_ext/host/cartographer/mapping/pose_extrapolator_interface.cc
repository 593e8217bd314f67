// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_extrapolator_interface.h"

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/mapping/pose_extrapolator.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::PoseExtrapolatorOptions CreatePoseExtrapolatorOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  proto::PoseExtrapolatorOptions options;
  options.set_use_imu_based(parameter_dictionary->GetBool("use_imu_based"));

  const auto constant_velocity =
      parameter_dictionary->GetDictionary("constant_velocity");
  auto* const velocity_options = options.mutable_constant_velocity();
  velocity_options->set_imu_gravity_time_constant(
      constant_velocity->GetDouble("imu_gravity_time_constant"));
  velocity_options->set_pose_queue_duration(
      constant_velocity->GetDouble("pose_queue_duration"));

  const auto imu_based = parameter_dictionary->GetDictionary("imu_based");
  auto* const imu_options = options.mutable_imu_based();
  imu_options->set_pose_queue_duration(
      imu_based->GetDouble("pose_queue_duration"));
  imu_options->set_gravity_constant(imu_based->GetDouble("gravity_constant"));
  imu_options->set_pose_translation_weight(
      imu_based->GetDouble("pose_translation_weight"));
  imu_options->set_pose_rotation_weight(
      imu_based->GetDouble("pose_rotation_weight"));
  imu_options->set_imu_acceleration_weight(
      imu_based->GetDouble("imu_acceleration_weight"));
  imu_options->set_imu_rotation_weight(
      imu_based->GetDouble("imu_rotation_weight"));
  imu_options->set_odometry_translation_weight(
      imu_based->GetDouble("odometry_translation_weight"));
  imu_options->set_odometry_rotation_weight(
      imu_based->GetDouble("odometry_rotation_weight"));
  *imu_options->mutable_solver_options() =
      common::CreateCeresSolverOptionsProto(
          imu_based->GetDictionary("solver_options").get());
  return options;
}

std::unique_ptr<PoseExtrapolatorInterface>
PoseExtrapolatorInterface::CreateWithImuData(
    const proto::PoseExtrapolatorOptions& options,
    const std::vector<sensor::ImuData>& imu_data,
    const std::vector<transform::TimestampedTransform>& initial_poses) {
  CHECK(!imu_data.empty());
  CHECK(!options.use_imu_based())
      << "pose_extrapolator.use_imu_based is not available in this host";
  const auto& velocity_options = options.constant_velocity();
  return PoseExtrapolator::InitializeWithImu(
      common::FromSeconds(velocity_options.pose_queue_duration()),
      velocity_options.imu_gravity_time_constant(), imu_data.back());
}

}  // namespace mapping
}  // namespace cartographer
