// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/trajectory_builder_interface.h"

#include "cartographer/common/internal/read_options.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"
#include "cartographer/mapping/internal/3d/options_3d.h"
#include "cartographer/mapping/internal/local_slam_result_data.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

using SensorId = TrajectoryBuilderInterface::SensorId;
using SensorType = SensorId::SensorType;

}  // namespace

proto::TrajectoryBuilderOptions CreateTrajectoryBuilderOptions(
    common::LuaParameterDictionary* const table) {
  auto options = common::ReadOptions<proto::TrajectoryBuilderOptions>(table);
  *options.mutable_trajectory_builder_2d_options() = common::ReadTable(
      table, "trajectory_builder_2d", &CreateLocalTrajectoryBuilderOptions2D);
  if (table->HasKey("trajectory_builder_3d")) {
    *options.mutable_trajectory_builder_3d_options() = common::ReadTable(
        table, "trajectory_builder_3d", &CreateLocalTrajectoryBuilderOptions3D);
  }
  using Trimmer =
      proto::TrajectoryBuilderOptions::PureLocalizationTrimmerOptions;
  common::ReadOptionalTable<Trimmer>(
      table, "pure_localization_trimmer",
      [&options]() { return options.mutable_pure_localization_trimmer(); });
  common::ReadOptionalTable<proto::MotionFilterOptions>(
      table, "pose_graph_odometry_motion_filter", [&options]() {
        return options.mutable_pose_graph_odometry_motion_filter();
      });
  return options;
}

// The types have the same numbers here and in files.
static_assert(static_cast<int>(SensorType::RANGE) == proto::SensorId::RANGE &&
                  static_cast<int>(SensorType::IMU) == proto::SensorId::IMU &&
                  static_cast<int>(SensorType::ODOMETRY) ==
                      proto::SensorId::ODOMETRY &&
                  static_cast<int>(SensorType::FIXED_FRAME_POSE) ==
                      proto::SensorId::FIXED_FRAME_POSE &&
                  static_cast<int>(SensorType::LANDMARK) ==
                      proto::SensorId::LANDMARK &&
                  static_cast<int>(SensorType::LOCAL_SLAM_RESULT) ==
                      proto::SensorId::LOCAL_SLAM_RESULT,
              "sensor types differ from those in files");

proto::SensorId ToProto(const SensorId& sensor_id) {
  proto::SensorId result;
  result.set_id(sensor_id.id);
  result.set_type(static_cast<proto::SensorId::SensorType>(sensor_id.type));
  return result;
}

SensorId FromProto(const proto::SensorId& sensor_id_proto) {
  // Files of a later version may have unknown types.
  const bool is_known =
      proto::SensorId::SensorType_IsValid(sensor_id_proto.type());
  return SensorId{is_known ? static_cast<SensorType>(sensor_id_proto.type())
                           : SensorType::RANGE,
                  sensor_id_proto.id()};
}

}  // namespace mapping
}  // namespace cartographer
