// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/global_trajectory_builder.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/types/optional.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/metrics/counter.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

auto* matching_results_metric = metrics::Counter::Null();
auto* insertion_results_metric = metrics::Counter::Null();

class GlobalTrajectoryBuilder2D : public TrajectoryBuilderInterface {
 public:
  GlobalTrajectoryBuilder2D(
      const int trajectory_id, PoseGraph2D* const pose_graph,
      const LocalSlamResultCallback& local_slam_result_callback)
      : trajectory_id_(trajectory_id),
        local_slam_result_callback_(local_slam_result_callback),
        pose_graph_(pose_graph) {}

  void StartLocalSlam(const proto::LocalTrajectoryBuilderOptions2D& options,
                      const std::set<SensorId>& sensor_ids) {
    std::vector<std::string> range_sensor_ids;
    for (const SensorId& sensor_id : sensor_ids) {
      const bool is_range_sensor =
          sensor_id.type == SensorId::SensorType::RANGE;
      if (is_range_sensor) range_sensor_ids.push_back(sensor_id.id);
    }
    local_slam_ =
        absl::make_unique<LocalTrajectoryBuilder2D>(options, range_sensor_ids);
  }

  void FilterOdometry(const proto::MotionFilterOptions& options) {
    odometry_motion_filter_.emplace(options);
  }

  void AddSensorData(
      const std::string& sensor_id,
      const sensor::TimedPointCloudData& timed_point_cloud_data) override {
    CHECK(local_slam_ != nullptr)
        << "trajectory " << trajectory_id_ << " takes no range data";
    auto matched = local_slam_->AddRangeData(sensor_id, timed_point_cloud_data);
    if (matched == nullptr) {
      return;
    }
    matching_results_metric->Increment();
    auto inserted = AddToPoseGraph(matched->insertion_result.get());
    if (local_slam_result_callback_) {
      local_slam_result_callback_(
          trajectory_id_, matched->time, matched->local_pose,
          std::move(matched->range_data_in_local), std::move(inserted));
    }
  }

  void AddSensorData(const std::string& /*sensor_id*/,
                     const sensor::ImuData& imu_data) override {
    if (local_slam_ != nullptr) {
      local_slam_->AddImuData(imu_data);
    }
    pose_graph_->AddImuData(trajectory_id_, imu_data);
  }

  void AddSensorData(const std::string& sensor_id,
                     const sensor::OdometryData& odometry_data) override {
    if (!odometry_data.pose.IsValid()) {
      LOG_EVERY_N(ERROR, 100) << "dropped an invalid pose of '" << sensor_id
                              << "': " << odometry_data.pose.DebugString();
      return;
    }
    if (local_slam_ != nullptr) {
      local_slam_->AddOdometryData(odometry_data);
    }
    if (odometry_motion_filter_.has_value() &&
        odometry_motion_filter_->IsSimilar(odometry_data.time,
                                           odometry_data.pose)) {
      return;
    }
    pose_graph_->AddOdometryData(trajectory_id_, odometry_data);
  }

  void AddSensorData(
      const std::string& sensor_id,
      const sensor::FixedFramePoseData& fixed_frame_pose) override {
    if (fixed_frame_pose.pose.has_value() &&
        !fixed_frame_pose.pose->IsValid()) {
      LOG_EVERY_N(ERROR, 100) << "dropped an invalid pose of '" << sensor_id
                              << "': " << fixed_frame_pose.pose->DebugString();
      return;
    }
    pose_graph_->AddFixedFramePoseData(trajectory_id_, fixed_frame_pose);
  }

  void AddSensorData(const std::string& /*sensor_id*/,
                     const sensor::LandmarkData& landmark_data) override {
    pose_graph_->AddLandmarkData(trajectory_id_, landmark_data);
  }

  void AddLocalSlamResultData(
      std::unique_ptr<LocalSlamResultData> local_slam_result_data) override {
    CHECK(local_slam_ == nullptr)
        << "trajectory " << trajectory_id_ << " has its own local SLAM";
    local_slam_result_data->AddToPoseGraph(trajectory_id_, pose_graph_);
  }

 private:
  std::unique_ptr<InsertionResult> AddToPoseGraph(
      const LocalTrajectoryBuilder2D::InsertionResult* const inserted) {
    if (inserted == nullptr) {
      return nullptr;
    }
    insertion_results_metric->Increment();
    const NodeId node_id = pose_graph_->AddNode(
        inserted->constant_data, trajectory_id_, inserted->insertion_submaps);
    return absl::make_unique<InsertionResult>(
        InsertionResult{node_id, inserted->constant_data,
                        std::vector<std::shared_ptr<const Submap>>(
                            inserted->insertion_submaps.begin(),
                            inserted->insertion_submaps.end())});
  }

  const int trajectory_id_;
  const LocalSlamResultCallback local_slam_result_callback_;
  PoseGraph2D* const pose_graph_;
  // Null where local SLAM runs elsewhere.
  std::unique_ptr<LocalTrajectoryBuilder2D> local_slam_;
  absl::optional<MotionFilter> odometry_motion_filter_;
};

}  // namespace

std::unique_ptr<TrajectoryBuilderInterface> CreateGlobalTrajectoryBuilder2D(
    const proto::TrajectoryBuilderOptions& options,
    const std::set<TrajectoryBuilderInterface::SensorId>& sensor_ids,
    const int trajectory_id, PoseGraph2D* const pose_graph,
    const TrajectoryBuilderInterface::LocalSlamResultCallback&
        local_slam_result_callback) {
  auto builder = absl::make_unique<GlobalTrajectoryBuilder2D>(
      trajectory_id, pose_graph, local_slam_result_callback);
  if (options.has_trajectory_builder_2d_options()) {
    builder->StartLocalSlam(options.trajectory_builder_2d_options(),
                            sensor_ids);
  }
  if (options.has_pose_graph_odometry_motion_filter()) {
    builder->FilterOdometry(options.pose_graph_odometry_motion_filter());
  }
  return builder;
}

void GlobalTrajectoryBuilderRegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  metrics::Family<metrics::Counter>& results =
      *family_factory->NewCounterFamily(
          "mapping_global_trajectory_builder_local_slam_results",
          "Results of local SLAM");
  for (const auto& name_metric :
       {std::make_pair("MatchingResult", &matching_results_metric),
        std::make_pair("InsertionResult", &insertion_results_metric)}) {
    *name_metric.second = results.Add({{"type", name_metric.first}});
  }
}

}  // namespace mapping
}  // namespace cartographer
