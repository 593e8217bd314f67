// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/trajectory_builder_interface.h"

#include "cartographer/mapping/internal/2d/local_trajectory_builder_options_2d.h"
#include "cartographer/mapping/internal/3d/options_3d.h"
#include "cartographer/mapping/internal/local_slam_result_data.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

using SensorId = TrajectoryBuilderInterface::SensorId;
using SensorType = SensorId::SensorType;

void MaybeReadPureLocalizationTrimmer(
    common::LuaParameterDictionary* const parameter_dictionary,
    proto::TrajectoryBuilderOptions* const options) {
  const std::string key = "pure_localization_trimmer";
  if (!parameter_dictionary->HasKey(key)) {
    return;
  }
  const auto dictionary = parameter_dictionary->GetDictionary(key);
  options->mutable_pure_localization_trimmer()->set_max_submaps_to_keep(
      dictionary->GetInt("max_submaps_to_keep"));
}

void MaybeReadPoseGraphOdometryMotionFilter(
    common::LuaParameterDictionary* const parameter_dictionary,
    proto::TrajectoryBuilderOptions* const options) {
  const std::string key = "pose_graph_odometry_motion_filter";
  if (!parameter_dictionary->HasKey(key)) {
    return;
  }
  const auto dictionary = parameter_dictionary->GetDictionary(key);
  auto* const filter = options->mutable_pose_graph_odometry_motion_filter();
  filter->set_max_time_seconds(dictionary->GetDouble("max_time_seconds"));
  filter->set_max_distance_meters(dictionary->GetDouble("max_distance_meters"));
  filter->set_max_angle_radians(dictionary->GetDouble("max_angle_radians"));
}

}  // namespace

proto::TrajectoryBuilderOptions CreateTrajectoryBuilderOptions(
    common::LuaParameterDictionary* const parameter_dictionary) {
  proto::TrajectoryBuilderOptions options;
  *options.mutable_trajectory_builder_2d_options() =
      CreateLocalTrajectoryBuilderOptions2D(
          parameter_dictionary->GetDictionary("trajectory_builder_2d").get());
  if (parameter_dictionary->HasKey("trajectory_builder_3d")) {
    *options.mutable_trajectory_builder_3d_options() =
        CreateLocalTrajectoryBuilderOptions3D(
            parameter_dictionary->GetDictionary("trajectory_builder_3d").get());
  }
  options.set_collate_fixed_frame(
      parameter_dictionary->GetBool("collate_fixed_frame"));
  options.set_collate_landmarks(
      parameter_dictionary->GetBool("collate_landmarks"));
  MaybeReadPureLocalizationTrimmer(parameter_dictionary, &options);
  MaybeReadPoseGraphOdometryMotionFilter(parameter_dictionary, &options);
  return options;
}

proto::SensorId ToProto(const SensorId& sensor_id) {
  proto::SensorId result;
  switch (sensor_id.type) {
    case SensorType::RANGE:
      result.set_type(proto::SensorId::RANGE);
      break;
    case SensorType::IMU:
      result.set_type(proto::SensorId::IMU);
      break;
    case SensorType::ODOMETRY:
      result.set_type(proto::SensorId::ODOMETRY);
      break;
    case SensorType::FIXED_FRAME_POSE:
      result.set_type(proto::SensorId::FIXED_FRAME_POSE);
      break;
    case SensorType::LANDMARK:
      result.set_type(proto::SensorId::LANDMARK);
      break;
    case SensorType::LOCAL_SLAM_RESULT:
      result.set_type(proto::SensorId::LOCAL_SLAM_RESULT);
      break;
  }
  result.set_id(sensor_id.id);
  return result;
}

SensorId FromProto(const proto::SensorId& sensor_id_proto) {
  const auto type = [&sensor_id_proto]() {
    switch (sensor_id_proto.type()) {
      case proto::SensorId::IMU:
        return SensorType::IMU;
      case proto::SensorId::ODOMETRY:
        return SensorType::ODOMETRY;
      case proto::SensorId::FIXED_FRAME_POSE:
        return SensorType::FIXED_FRAME_POSE;
      case proto::SensorId::LANDMARK:
        return SensorType::LANDMARK;
      case proto::SensorId::LOCAL_SLAM_RESULT:
        return SensorType::LOCAL_SLAM_RESULT;
      default:
        return SensorType::RANGE;
    }
  }();
  return SensorId{type, sensor_id_proto.id()};
}

}  // namespace mapping
}  // namespace cartographer
