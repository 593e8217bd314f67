// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/metrics/gauge.h"
#include "cartographer/metrics/histogram.h"
#include "cartographer/transform/transform.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {
namespace {

auto* latency_metric = metrics::Gauge::Null();
auto* real_time_ratio_metric = metrics::Gauge::Null();
auto* cpu_real_time_ratio_metric = metrics::Gauge::Null();
auto* correlative_score_metric = metrics::Histogram::Null();
auto* ceres_cost_metric = metrics::Histogram::Null();
auto* residual_distance_metric = metrics::Histogram::Null();
auto* residual_angle_metric = metrics::Histogram::Null();

}  // namespace

LocalTrajectoryBuilder2D::LocalTrajectoryBuilder2D(
    const proto::LocalTrajectoryBuilderOptions2D& options,
    const std::vector<std::string>& expected_range_sensor_ids)
    : options_(options),
      range_data_collator_(expected_range_sensor_ids),
      accumulator_(options),
      real_time_correlative_scan_matcher_(
          options.real_time_correlative_scan_matcher_options()),
      ceres_scan_matcher_(options.ceres_scan_matcher_options()),
      motion_filter_(options.motion_filter_options()),
      active_submaps_(options.submaps_options()) {
  CHECK(!options_.pose_extrapolator_options().use_imu_based())
      << "pose_extrapolator.use_imu_based is not available in 2D";
}

LocalTrajectoryBuilder2D::~LocalTrajectoryBuilder2D() {}

void LocalTrajectoryBuilder2D::InitializeExtrapolator(const common::Time time) {
  if (extrapolator_ != nullptr) {
    return;
  }
  const auto& extrapolator_options =
      options_.pose_extrapolator_options().constant_velocity();
  extrapolator_ = absl::make_unique<PoseExtrapolator>(
      common::FromSeconds(extrapolator_options.pose_queue_duration()),
      extrapolator_options.imu_gravity_time_constant());
  extrapolator_->AddPose(time, transform::Rigid3d::Identity());
}

void LocalTrajectoryBuilder2D::AddImuData(const sensor::ImuData& imu_data) {
  if (!options_.use_imu_data()) {
    LOG_EVERY_N(WARNING, 1000) << "IMU data is ignored: use_imu_data is false";
    return;
  }
  InitializeExtrapolator(imu_data.time);
  extrapolator_->AddImuData(imu_data);
}

void LocalTrajectoryBuilder2D::AddOdometryData(
    const sensor::OdometryData& odometry_data) {
  if (extrapolator_ == nullptr) {
    LOG_EVERY_N(INFO, 100) << "odometry before the first scan is ignored";
    return;
  }
  extrapolator_->AddOdometryData(odometry_data);
}

std::unique_ptr<LocalTrajectoryBuilder2D::MatchingResult>
LocalTrajectoryBuilder2D::AddRangeData(
    const std::string& sensor_id,
    const sensor::TimedPointCloudData& range_data) {
  const sensor::TimedPointCloudOriginData sweep =
      range_data_collator_.AddRangeData(sensor_id, range_data);
  if (sweep.ranges.empty()) {
    return nullptr;
  }
  if (!options_.use_imu_data()) {
    InitializeExtrapolator(sweep.time);
  }
  if (extrapolator_ == nullptr) {
    LOG_EVERY_N(INFO, 100) << "waiting for the IMU";
    return nullptr;
  }
  const common::Time time_of_first_point =
      sweep.time + common::FromSeconds(sweep.ranges.front().point_time.time);
  if (time_of_first_point < extrapolator_->GetLastPoseTime()) {
    LOG_EVERY_N(INFO, 100) << "the scan begins before the last pose";
    return nullptr;
  }

  const std::vector<transform::Rigid3f> poses = ExtrapolatePoses(sweep);
  accumulator_.Add(sweep, poses);
  if (!accumulator_.IsComplete()) {
    return nullptr;
  }
  Scan scan;
  scan.time = sweep.time;
  scan.gravity_alignment =
      extrapolator_->EstimateGravityOrientation(sweep.time);
  scan.range_data = accumulator_.Take(
      poses.back(),
      transform::Rigid3d::Rotation(scan.gravity_alignment).cast<float>());
  if (scan.range_data.returns.empty()) {
    LOG_EVERY_N(WARNING, 100) << "a scan without returns is dropped";
    return nullptr;
  }
  scan.cloud = sensor::AdaptiveVoxelFilter(
      scan.range_data.returns, options_.adaptive_voxel_filter_options());
  return scan.cloud.empty() ? nullptr : MatchAndInsert(scan);
}

std::vector<transform::Rigid3f> LocalTrajectoryBuilder2D::ExtrapolatePoses(
    const sensor::TimedPointCloudOriginData& sweep) {
  std::vector<transform::Rigid3f> poses;
  poses.reserve(sweep.ranges.size());
  float previous_offset = 0.f;
  for (const auto& range : sweep.ranges) {
    const float offset = range.point_time.time;
    if (!poses.empty() && offset == previous_offset) {
      poses.push_back(transform::Rigid3f(poses.back()));
      continue;
    }
    previous_offset = offset;
    common::Time time = sweep.time + common::FromSeconds(offset);
    if (time < extrapolator_->GetLastExtrapolatedTime()) {
      LOG_EVERY_N(WARNING, 1000) << "a point comes from before the last one";
      time = extrapolator_->GetLastExtrapolatedTime();
    }
    poses.push_back(extrapolator_->ExtrapolatePose(time).cast<float>());
  }
  return poses;
}

std::unique_ptr<LocalTrajectoryBuilder2D::MatchingResult>
LocalTrajectoryBuilder2D::MatchAndInsert(const Scan& scan) {
  const auto tilt = transform::Rigid3d::Rotation(scan.gravity_alignment);
  const transform::Rigid3d predicted =
      extrapolator_->ExtrapolatePose(scan.time) * tilt.inverse();
  const transform::Rigid2d matched =
      Match(transform::Project2D(predicted), scan.cloud);

  auto result = absl::make_unique<MatchingResult>();
  result->time = scan.time;
  result->local_pose = transform::Embed3D(matched) * tilt;
  result->range_data_in_local = sensor::TransformRangeData(
      scan.range_data, transform::Embed3D(matched.cast<float>()));
  extrapolator_->AddPose(result->time, result->local_pose);
  if (!motion_filter_.IsSimilar(result->time, result->local_pose)) {
    result->insertion_result = Insert(scan, *result);
  }
  ReportSpeed(scan.time);
  return result;
}

transform::Rigid2d LocalTrajectoryBuilder2D::Match(
    const transform::Rigid2d& prediction, const sensor::PointCloud& cloud) {
  const auto submaps = active_submaps_.submaps();
  if (submaps.empty()) {
    return prediction;
  }
  // The older submap contains more scans.
  const Grid2D& grid = *submaps.front()->grid();
  transform::Rigid2d initial = prediction;
  if (options_.use_online_correlative_scan_matching()) {
    correlative_score_metric->Observe(real_time_correlative_scan_matcher_.Match(
        prediction, cloud, grid, &initial));
  }
  transform::Rigid2d matched;
  ceres::Solver::Summary summary;
  ceres_scan_matcher_.Match(prediction.translation(), initial, cloud, grid,
                            &matched, &summary);
  ceres_cost_metric->Observe(summary.final_cost);
  residual_distance_metric->Observe(
      (matched.translation() - prediction.translation()).norm());
  residual_angle_metric->Observe(
      std::abs(matched.rotation().angle() - prediction.rotation().angle()));
  return matched;
}

std::unique_ptr<LocalTrajectoryBuilder2D::InsertionResult>
LocalTrajectoryBuilder2D::Insert(const Scan& scan,
                                 const MatchingResult& matched) {
  TrajectoryNode::Data node;
  node.time = scan.time;
  node.gravity_alignment = scan.gravity_alignment;
  node.filtered_gravity_aligned_point_cloud = scan.cloud;
  node.local_pose = matched.local_pose;
  return absl::make_unique<InsertionResult>(InsertionResult{
      std::make_shared<const TrajectoryNode::Data>(std::move(node)),
      active_submaps_.InsertRangeData(matched.range_data_in_local)});
}

void LocalTrajectoryBuilder2D::ReportSpeed(const common::Time time) {
  const Clocks now{time, std::chrono::steady_clock::now(),
                   common::GetThreadCpuTimeSeconds()};
  if (last_clocks_.has_value()) {
    const double sensor_seconds =
        common::ToSeconds(now.sensor - last_clocks_->sensor);
    const double wall_seconds =
        common::ToSeconds(now.wall - last_clocks_->wall);
    latency_metric->Set(wall_seconds);
    real_time_ratio_metric->Set(sensor_seconds / wall_seconds);
    cpu_real_time_ratio_metric->Set(
        sensor_seconds / (now.cpu_seconds - last_clocks_->cpu_seconds));
  }
  last_clocks_ = now;
}

void LocalTrajectoryBuilder2D::RegisterMetrics(
    metrics::FamilyFactory* const family_factory) {
  const auto gauge = [family_factory](const std::string& name,
                                      const std::string& description) {
    return family_factory
        ->NewGaugeFamily("mapping_2d_local_trajectory_builder_" + name,
                         description)
        ->Add({});
  };
  latency_metric =
      gauge("latency", "Seconds between the last two results of local SLAM");
  real_time_ratio_metric =
      gauge("real_time_ratio", "Sensor time over wall time");
  cpu_real_time_ratio_metric =
      gauge("cpu_real_time_ratio", "Sensor time over CPU time");

  correlative_score_metric =
      family_factory
          ->NewHistogramFamily("mapping_2d_local_trajectory_builder_scores",
                               "Scores of local scan matching",
                               metrics::Histogram::FixedWidth(0.05, 20))
          ->Add({{"scan_matcher", "real_time_correlative"}});
  ceres_cost_metric =
      family_factory
          ->NewHistogramFamily("mapping_2d_local_trajectory_builder_costs",
                               "Costs of local scan matching",
                               metrics::Histogram::ScaledPowersOf(2, 0.01, 100))
          ->Add({{"scan_matcher", "ceres"}});
  auto* const residuals = family_factory->NewHistogramFamily(
      "mapping_2d_local_trajectory_builder_residuals",
      "How far matches are from predictions",
      metrics::Histogram::ScaledPowersOf(2, 0.01, 10));
  residual_distance_metric = residuals->Add({{"component", "distance"}});
  residual_angle_metric = residuals->Add({{"component", "angle"}});
}

}  // namespace mapping
}  // namespace cartographer
