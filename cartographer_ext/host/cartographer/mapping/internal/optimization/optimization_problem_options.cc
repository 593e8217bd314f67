// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/optimization/optimization_problem_options.h"

#include "cartographer/common/internal/ceres_solver_options.h"

namespace cartographer {
namespace mapping {
namespace optimization {

proto::OptimizationProblemOptions CreateOptimizationProblemOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  common::LuaParameterDictionary& lua = *parameter_dictionary;
  proto::OptimizationProblemOptions options;
  options.set_huber_scale(lua.GetDouble("huber_scale"));
  options.set_local_slam_pose_translation_weight(
      lua.GetDouble("local_slam_pose_translation_weight"));
  options.set_local_slam_pose_rotation_weight(
      lua.GetDouble("local_slam_pose_rotation_weight"));
  options.set_odometry_translation_weight(
      lua.GetDouble("odometry_translation_weight"));
  options.set_odometry_rotation_weight(
      lua.GetDouble("odometry_rotation_weight"));
  options.set_fixed_frame_pose_translation_weight(
      lua.GetDouble("fixed_frame_pose_translation_weight"));
  options.set_fixed_frame_pose_rotation_weight(
      lua.GetDouble("fixed_frame_pose_rotation_weight"));
  options.set_fixed_frame_pose_use_tolerant_loss(
      lua.GetBool("fixed_frame_pose_use_tolerant_loss"));
  options.set_fixed_frame_pose_tolerant_loss_param_a(
      lua.GetDouble("fixed_frame_pose_tolerant_loss_param_a"));
  options.set_fixed_frame_pose_tolerant_loss_param_b(
      lua.GetDouble("fixed_frame_pose_tolerant_loss_param_b"));
  options.set_log_solver_summary(lua.GetBool("log_solver_summary"));
  *options.mutable_ceres_solver_options() =
      common::CreateCeresSolverOptionsProto(
          lua.GetDictionary("ceres_solver_options").get());
  // Only 3D uses these.
  options.set_acceleration_weight(lua.GetDouble("acceleration_weight"));
  options.set_rotation_weight(lua.GetDouble("rotation_weight"));
  options.set_use_online_imu_extrinsics_in_3d(
      lua.GetBool("use_online_imu_extrinsics_in_3d"));
  options.set_fix_z_in_3d(lua.GetBool("fix_z_in_3d"));
  return options;
}

}  // namespace optimization
}  // namespace mapping
}  // namespace cartographer
