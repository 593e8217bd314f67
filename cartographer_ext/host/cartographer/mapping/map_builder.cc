// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/map_builder.h"

#include <sys/stat.h>

#include <cstdio>
#include <fstream>
#include <utility>

#include "absl/memory/memory.h"
#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer/io/internal/mapping_state_serialization.h"
#include "cartographer/io/proto_stream.h"
#include "cartographer/mapping/internal/2d/pose_graph_2d.h"
#include "cartographer/mapping/internal/collated_trajectory_builder.h"
#include "cartographer/mapping/internal/global_trajectory_builder.h"
#include "cartographer/mapping/internal/stored_state.h"
#include "cartographer/sensor/internal/collator.h"
#include "cartographer/sensor/internal/trajectory_collator.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

using proto::SerializedData;

// The number of submaps kept by pure_localization, which has no option for it.
constexpr int kDefaultNumSubmapsToKeep = 3;

// pure_localization is deprecated, but stored options may still use it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
bool HasDeprecatedPureLocalization(
    const proto::TrajectoryBuilderOptions& options) {
  return options.pure_localization();
}
#pragma GCC diagnostic pop

// Empty if all submaps are to be kept.
absl::optional<int> NumSubmapsToKeep(
    const proto::TrajectoryBuilderOptions& options) {
  if (HasDeprecatedPureLocalization(options)) {
    LOG(WARNING) << "pure_localization is deprecated, use "
                    "pure_localization_trimmer.max_submaps_to_keep";
    return kDefaultNumSubmapsToKeep;
  }
  if (options.has_pure_localization_trimmer()) {
    return options.pure_localization_trimmer().max_submaps_to_keep();
  }
  return absl::nullopt;
}

// The options of a trajectory that are stored.
proto::TrajectoryBuilderOptionsWithSensorIds WithSensorIds(
    const proto::TrajectoryBuilderOptions& options,
    const std::set<MapBuilder::SensorId>& sensor_ids) {
  proto::TrajectoryBuilderOptionsWithSensorIds result;
  *result.mutable_trajectory_builder_options() = options;
  for (const MapBuilder::SensorId& sensor_id : sensor_ids) {
    *result.add_sensor_id() = ToProto(sensor_id);
  }
  return result;
}

std::unique_ptr<sensor::CollatorInterface> MakeCollator(
    const bool by_trajectory) {
  if (by_trajectory) {
    return absl::make_unique<sensor::TrajectoryCollator>();
  }
  return absl::make_unique<sensor::Collator>();
}

// Passes one record to the pose graph.
class RecordLoader {
 public:
  RecordLoader(const StoredState& state, const bool frozen,
               PoseGraph* const pose_graph)
      : submap_poses_(state.SubmapPoses()),
        node_poses_(state.NodePoses()),
        frozen_(frozen),
        pose_graph_(pose_graph) {}

  void Load(const SerializedData& record) {
    switch (record.data_case()) {
      case SerializedData::kSubmap: {
        const proto::SubmapId& id = record.submap().submap_id();
        pose_graph_->AddSubmapFromProto(
            submap_poses_.at(SubmapId{id.trajectory_id(), id.submap_index()}),
            record.submap());
        return;
      }
      case SerializedData::kNode: {
        const proto::NodeId& id = record.node().node_id();
        pose_graph_->AddNodeFromProto(
            node_poses_.at(NodeId{id.trajectory_id(), id.node_index()}),
            record.node());
        return;
      }
      case SerializedData::kTrajectoryData:
        pose_graph_->SetTrajectoryDataFromProto(record.trajectory_data());
        return;
      default:
        // Sensor data would only constrain poses, and those of a frozen state
        // are fixed.
        if (!frozen_) LoadSensorData(record);
    }
  }

 private:
  void LoadSensorData(const SerializedData& record) {
    switch (record.data_case()) {
      case SerializedData::kImuData:
        pose_graph_->AddImuData(
            record.imu_data().trajectory_id(),
            sensor::FromProto(record.imu_data().imu_data()));
        return;
      case SerializedData::kOdometryData:
        pose_graph_->AddOdometryData(
            record.odometry_data().trajectory_id(),
            sensor::FromProto(record.odometry_data().odometry_data()));
        return;
      case SerializedData::kFixedFramePoseData:
        pose_graph_->AddFixedFramePoseData(
            record.fixed_frame_pose_data().trajectory_id(),
            sensor::FromProto(
                record.fixed_frame_pose_data().fixed_frame_pose_data()));
        return;
      case SerializedData::kLandmarkData:
        pose_graph_->AddLandmarkData(
            record.landmark_data().trajectory_id(),
            sensor::FromProto(record.landmark_data().landmark_data()));
        return;
      default:
        LOG(WARNING) << "skipped a record of an unknown kind";
    }
  }

  const MapById<SubmapId, transform::Rigid3d> submap_poses_;
  const MapById<NodeId, transform::Rigid3d> node_poses_;
  const bool frozen_;
  PoseGraph* const pose_graph_;
};

}  // namespace

MapBuilder::MapBuilder(const proto::MapBuilderOptions& options)
    : options_(options),
      thread_pool_(options.num_background_threads()),
      sensor_collator_(MakeCollator(options.collate_by_trajectory())) {
  CHECK(options_.use_trajectory_builder_2d() &&
        !options_.use_trajectory_builder_3d())
      << "this host maps in 2D only";
  const proto::PoseGraphOptions& graph = options_.pose_graph_options();
  pose_graph_ = absl::make_unique<PoseGraph2D>(
      graph,
      absl::make_unique<optimization::OptimizationProblem2D>(
          graph.optimization_problem_options()),
      &thread_pool_);
}

MapBuilder::~MapBuilder() {}

mapping::PoseGraphInterface* MapBuilder::pose_graph() {
  return pose_graph_.get();
}

int MapBuilder::AddTrajectoryBuilder(
    const std::set<SensorId>& expected_sensor_ids,
    const proto::TrajectoryBuilderOptions& trajectory_options,
    LocalSlamResultCallback local_slam_result_callback) {
  const int id = AddTrajectoryForDeserialization(
      WithSensorIds(trajectory_options, expected_sensor_ids));
  auto builder = CreateGlobalTrajectoryBuilder2D(
      trajectory_options, expected_sensor_ids, id, pose_graph_.get(),
      local_slam_result_callback);
  trajectory_builders_.at(id) = absl::make_unique<CollatedTrajectoryBuilder>(
      trajectory_options, sensor_collator_.get(), id, expected_sensor_ids,
      std::move(builder));
  AddToPoseGraph(id, trajectory_options);
  return id;
}

void MapBuilder::AddToPoseGraph(
    const int trajectory_id, const proto::TrajectoryBuilderOptions& options) {
  if (options.has_initial_trajectory_pose()) {
    const proto::InitialTrajectoryPose& start =
        options.initial_trajectory_pose();
    pose_graph_->SetInitialTrajectoryPose(
        trajectory_id, start.to_trajectory_id(),
        transform::ToRigid3(start.relative_pose()),
        common::FromUniversal(start.timestamp()));
  }
  const absl::optional<int> num_submaps = NumSubmapsToKeep(options);
  if (num_submaps.has_value()) {
    pose_graph_->AddTrimmer(absl::make_unique<PureLocalizationTrimmer>(
        trajectory_id, *num_submaps));
  }
}

int MapBuilder::AddTrajectoryForDeserialization(
    const proto::TrajectoryBuilderOptionsWithSensorIds&
        options_with_sensor_ids_proto) {
  trajectory_builders_.emplace_back();
  all_trajectory_builder_options_.push_back(options_with_sensor_ids_proto);
  return num_trajectory_builders() - 1;
}

void MapBuilder::FinishTrajectory(const int trajectory_id) {
  sensor_collator_->FinishTrajectory(trajectory_id);
  pose_graph_->FinishTrajectory(trajectory_id);
}

std::string MapBuilder::SubmapToProto(
    const SubmapId& submap_id, proto::SubmapQuery::Response* const response) {
  if (submap_id.trajectory_id < 0 ||
      submap_id.trajectory_id >= num_trajectory_builders()) {
    return absl::StrCat("there is no trajectory ", submap_id.trajectory_id,
                        ", but ", num_trajectory_builders(), " from 0 on");
  }
  const PoseGraphInterface::SubmapData submap_data =
      pose_graph_->GetSubmapData(submap_id);
  if (submap_data.submap == nullptr) {
    return absl::StrCat("there is no submap ", submap_id.submap_index,
                        " in trajectory ", submap_id.trajectory_id,
                        "; it may have been trimmed");
  }
  submap_data.submap->ToResponseProto(submap_data.pose, response);
  return "";
}

void MapBuilder::SerializeState(const bool include_unfinished_submaps,
                                io::ProtoStreamWriterInterface* const writer) {
  pose_graph_->WaitForAllComputations();
  io::WritePbStream(*pose_graph_, all_trajectory_builder_options_, writer,
                    include_unfinished_submaps);
}

bool MapBuilder::SerializeStateToFile(const bool include_unfinished_submaps,
                                      const std::string& filename) {
  // A file of this name is always a complete one. Devices and pipes are written
  // to, not replaced.
  struct stat existing;
  const mode_t kind =
      ::stat(filename.c_str(), &existing) == 0 ? existing.st_mode : 0;
  const bool in_place = S_ISCHR(kind) || S_ISBLK(kind) || S_ISFIFO(kind);
  const std::string partial = in_place ? filename : filename + ".partial";
  // A pipe is opened once only: its reader takes the first end for the last.
  if (!S_ISFIFO(kind) && !std::ofstream(partial, std::ios::binary).good()) {
    LOG(ERROR) << "cannot write " << partial;
    return false;
  }
  io::ProtoStreamWriter writer(partial);
  SerializeState(include_unfinished_submaps, &writer);
  if (writer.Close() &&
      (in_place || std::rename(partial.c_str(), filename.c_str()) == 0)) {
    return true;
  }
  LOG(ERROR) << "cannot write " << filename;
  if (!in_place) std::remove(partial.c_str());
  return false;
}

std::map<int, int> MapBuilder::LoadState(
    io::ProtoStreamReaderInterface* const reader,
    const bool load_frozen_state) {
  absl::StatusOr<StoredState> state = ReadStoredState(reader);
  if (!state.ok()) {
    LOG(ERROR) << state.status().message();
    return {};
  }
  std::map<int, int> new_ids;
  for (int i = 0; i < state->pose_graph.trajectory_size(); ++i) {
    const int id = AddTrajectoryForDeserialization(
        state->builder_options.options_with_sensor_ids(i));
    new_ids[state->pose_graph.trajectory(i).trajectory_id()] = id;
    if (load_frozen_state) {
      pose_graph_->FreezeTrajectory(id);
    }
  }
  state->Renumber(new_ids);
  for (const auto& landmark : state->pose_graph.landmark_poses()) {
    pose_graph_->SetLandmarkPose(landmark.landmark_id(),
                                 transform::ToRigid3(landmark.global_pose()),
                                 true /* frozen */);
  }
  RecordLoader loader(*state, load_frozen_state, pose_graph_.get());
  for (SerializedData& record : state->records) {
    loader.Load(record);
    record.Clear();
  }
  const auto constraints = FromProto(state->pose_graph.constraint());
  if (!load_frozen_state) {
    pose_graph_->AddSerializedConstraints(constraints);
    return new_ids;
  }
  // No pose moves, so that constraints only record which nodes built a submap.
  for (const PoseGraph::Constraint& constraint : constraints) {
    if (constraint.tag == PoseGraph::Constraint::INTRA_SUBMAP) {
      pose_graph_->AddNodeToSubmap(constraint.node_id, constraint.submap_id);
    }
  }
  return new_ids;
}

std::map<int, int> MapBuilder::LoadStateFromFile(const std::string& filename,
                                                 const bool load_frozen_state) {
  LOG(INFO) << "loading " << filename;
  io::ProtoStreamReader reader(filename);
  return LoadState(&reader, load_frozen_state);
}

std::unique_ptr<MapBuilderInterface> CreateMapBuilder(
    const proto::MapBuilderOptions& options) {
  return absl::make_unique<MapBuilder>(options);
}

}  // namespace mapping
}  // namespace cartographer
