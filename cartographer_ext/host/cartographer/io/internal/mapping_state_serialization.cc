// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/io/internal/mapping_state_serialization.h"

#include "Eigen/Geometry"
#include "cartographer/common/time.h"
#include "cartographer/io/internal/submap_record.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/proto/serialization.pb.h"
#include "cartographer/sensor/fixed_frame_pose_data.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/transform/transform.h"

namespace cartographer {
namespace io {
namespace {

using mapping::proto::SerializedData;

// Writes every reading of every trajectory as a record of its own; `fill`
// converts one.
template <typename DataType, typename Fill>
void WriteReadings(const sensor::MapByTime<DataType>& readings,
                   const Fill& fill, ProtoStreamWriterInterface* const writer) {
  for (const int trajectory_id : readings.trajectory_ids()) {
    for (const DataType& reading : readings.trajectory(trajectory_id)) {
      SerializedData record;
      fill(trajectory_id, reading, &record);
      writer->WriteProto(record);
    }
  }
}

SerializedData TrajectoryDataRecord(
    const int trajectory_id,
    const mapping::PoseGraphInterface::TrajectoryData& data) {
  SerializedData record;
  auto* const proto = record.mutable_trajectory_data();
  proto->set_trajectory_id(trajectory_id);
  proto->set_gravity_constant(data.gravity_constant);
  const auto& q = data.imu_calibration;  // w, x, y, z
  *proto->mutable_imu_calibration() =
      transform::ToProto(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
  if (data.fixed_frame_origin_in_map.has_value()) {
    *proto->mutable_fixed_frame_origin_in_map() =
        transform::ToProto(*data.fixed_frame_origin_in_map);
  }
  return record;
}

SerializedData LandmarkRecord(
    const std::string& id,
    const mapping::PoseGraphInterface::LandmarkNode::LandmarkObservation&
        observation) {
  SerializedData record;
  record.mutable_landmark_data()->set_trajectory_id(observation.trajectory_id);
  auto* const data = record.mutable_landmark_data()->mutable_landmark_data();
  data->set_timestamp(common::ToUniversal(observation.time));
  auto* const proto = data->add_landmark_observations();
  proto->set_id(id);
  *proto->mutable_landmark_to_tracking_transform() =
      transform::ToProto(observation.landmark_to_tracking_transform);
  proto->set_translation_weight(observation.translation_weight);
  proto->set_rotation_weight(observation.rotation_weight);
  return record;
}

void WriteSubmap(const mapping::SubmapId& id, const mapping::Submap& submap,
                 ProtoStreamWriterInterface* const writer) {
  const auto* const submap_2d = dynamic_cast<const mapping::Submap2D*>(&submap);
  if (submap_2d != nullptr && submap_2d->grid() != nullptr &&
      submap_2d->grid()->GetGridType() == mapping::GridType::PROBABILITY_GRID) {
    writer->WriteSerialized(
        [&](const ProtoStreamWriterInterface::Write& write) {
          WriteSubmapRecord(id, *submap_2d, write);
        });
    return;
  }
  SerializedData record;
  *record.mutable_submap() = submap.ToProto(/*include_grid_data=*/true);
  id.ToProto(record.mutable_submap()->mutable_submap_id());
  writer->WriteProto(record);
}

}  // namespace

void WritePbStream(
    const mapping::PoseGraph& pose_graph,
    const std::vector<mapping::proto::TrajectoryBuilderOptionsWithSensorIds>&
        builder_options,
    ProtoStreamWriterInterface* const writer,
    const bool include_unfinished_submaps) {
  mapping::proto::SerializationHeader header;
  header.set_format_version(kMappingStateSerializationFormatVersion);
  writer->WriteProto(header);

  SerializedData graph_record;
  *graph_record.mutable_pose_graph() =
      pose_graph.ToProto(include_unfinished_submaps);
  writer->WriteProto(graph_record);

  // Readers pair options and trajectories by position.
  SerializedData options_record;
  auto* const options = options_record.mutable_all_trajectory_builder_options();
  for (const auto& trajectory : graph_record.pose_graph().trajectory()) {
    *options->add_options_with_sensor_ids() =
        builder_options.at(trajectory.trajectory_id());
  }
  writer->WriteProto(options_record);

  for (const auto& submap : pose_graph.GetAllSubmapData()) {
    if (!include_unfinished_submaps &&
        !submap.data.submap->insertion_finished()) {
      continue;
    }
    WriteSubmap(submap.id, *submap.data.submap, writer);
  }
  for (const auto& node : pose_graph.GetTrajectoryNodes()) {
    SerializedData record;
    node.id.ToProto(record.mutable_node()->mutable_node_id());
    *record.mutable_node()->mutable_node_data() =
        mapping::ToProto(*node.data.constant_data);
    writer->WriteProto(record);
  }
  for (const auto& id_data : pose_graph.GetTrajectoryData()) {
    writer->WriteProto(TrajectoryDataRecord(id_data.first, id_data.second));
  }
  WriteReadings(
      pose_graph.GetImuData(),
      [](const int trajectory_id, const sensor::ImuData& reading,
         SerializedData* const record) {
        record->mutable_imu_data()->set_trajectory_id(trajectory_id);
        *record->mutable_imu_data()->mutable_imu_data() =
            sensor::ToProto(reading);
      },
      writer);
  WriteReadings(
      pose_graph.GetOdometryData(),
      [](const int trajectory_id, const sensor::OdometryData& reading,
         SerializedData* const record) {
        record->mutable_odometry_data()->set_trajectory_id(trajectory_id);
        *record->mutable_odometry_data()->mutable_odometry_data() =
            sensor::ToProto(reading);
      },
      writer);
  WriteReadings(
      pose_graph.GetFixedFramePoseData(),
      [](const int trajectory_id, const sensor::FixedFramePoseData& reading,
         SerializedData* const record) {
        auto* const proto = record->mutable_fixed_frame_pose_data();
        proto->set_trajectory_id(trajectory_id);
        *proto->mutable_fixed_frame_pose_data() = sensor::ToProto(reading);
      },
      writer);
  for (const auto& id_landmark : pose_graph.GetLandmarkNodes()) {
    for (const auto& observation : id_landmark.second.landmark_observations) {
      writer->WriteProto(LandmarkRecord(id_landmark.first, observation));
    }
  }
}

}  // namespace io
}  // namespace cartographer
