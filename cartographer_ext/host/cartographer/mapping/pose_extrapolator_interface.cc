// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/pose_extrapolator_interface.h"

#include "cartographer/common/internal/ceres_solver_options.h"
#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/pose_extrapolator.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

proto::PoseExtrapolatorOptions CreatePoseExtrapolatorOptions(
    common::LuaParameterDictionary* const table) {
  using Options = proto::PoseExtrapolatorOptions;
  auto options = common::ReadOptions<Options>(table);
  common::ReadFields(table->GetDictionary("constant_velocity").get(),
                     options.mutable_constant_velocity());
  const auto imu_based = table->GetDictionary("imu_based");
  common::ReadFields(imu_based.get(), options.mutable_imu_based());
  *options.mutable_imu_based()->mutable_solver_options() =
      common::ReadTable(imu_based.get(), "solver_options",
                        &common::CreateCeresSolverOptionsProto);
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
