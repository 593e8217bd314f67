// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/adaptive_local_trajectory_builder_2d.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/common/planar_matrix.h"
#include "cartographer_ext/front_end/dropin/front_end_metrics.h"
#include "cartographer_ext/front_end/front_end_options.h"
#include "cartographer_ext/front_end/match_record.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::PointCloud;
using cartographer::sensor::RangeData;
using cartographer::transform::Rigid2d;
using cartographer::transform::Rigid3d;

namespace mapping = cartographer::mapping;

// Below this weight a direction counts as not determined by the scan.
constexpr double kDetermined = 0.5;

// So many scans begin a map, whether the robot moves or not: one scan is too
// little to match the next one with.
constexpr int kFirstScans = 5;

// Whether the scan tells how far the robot went in the direction it went.
bool WayIsDetermined(const scan_matching::DegeneracyResult& degeneracy,
                     const Pose2& from, const Pose2& to) {
  const Eigen::Vector2d way(to.x - from.x, to.y - from.y);
  const double length = way.norm();
  const Eigen::Vector2d heading =
      length > 0.01 ? Eigen::Vector2d(way / length)
                    : Eigen::Vector2d(std::cos(to.theta), std::sin(to.theta));
  double weight = 0.;
  for (int i = 0; i < 2; ++i) {
    const double along = degeneracy.eigenvectors.col(i).dot(heading);
    weight += along * along * degeneracy.translation_weights(i);
  }
  return weight > kDetermined;
}

// A covariance in the frame of the map, as seen by the robot at `pose`.
Eigen::Matrix3d InFrameOf(const Pose2& pose,
                          const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d rotation = PlanarRotation(pose.theta);
  return rotation.transpose() * covariance * rotation;
}

}  // namespace

AdaptiveLocalTrajectoryBuilder2D::AdaptiveLocalTrajectoryBuilder2D(
    const mapping::proto::LocalTrajectoryBuilderOptions2D& options,
    const proto::FrontEndOptions& extension,
    const std::vector<std::string>& expected_range_sensor_ids)
    : options_(options),
      extension_(extension),
      context_(PoseGraphContext::Current()),
      recorder_(context_ == nullptr ? nullptr : context_->Get<MatchRecorder>()),
      builder_number_(recorder_ == nullptr ? 0 : recorder_->AddBuilder()),
      active_submaps_(options.submaps_options()),
      motion_filter_(options.motion_filter_options()),
      range_data_collator_(expected_range_sensor_ids),
      assembler_(options,
                 ToWallFillingOptions(
                     extension,
                     options.submaps_options().grid_options_2d().resolution())),
      predictor_(ToMotionPredictorOptions(extension)),
      matcher_(extension, options.ceres_scan_matcher_options()) {}

AdaptiveLocalTrajectoryBuilder2D::~AdaptiveLocalTrajectoryBuilder2D() {}

double AdaptiveLocalTrajectoryBuilder2D::Seconds(
    const cartographer::common::Time time) {
  if (!has_start_) {
    has_start_ = true;
    start_ = time;
  }
  return cartographer::common::ToSeconds(time - start_);
}

Eigen::Quaterniond AdaptiveLocalTrajectoryBuilder2D::GravityAlignment() const {
  if (imu_tracker_ == nullptr) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d up =
      imu_tracker_->orientation().conjugate() * Eigen::Vector3d::UnitZ();
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
}

void AdaptiveLocalTrajectoryBuilder2D::AddImuData(
    const cartographer::sensor::ImuData& imu_data) {
  if (!options_.use_imu_data()) {
    LOG_EVERY_N(WARNING, 1000) << "IMU data is ignored: use_imu_data is false";
    return;
  }
  if (!imu_data.linear_acceleration.allFinite() ||
      !imu_data.angular_velocity.allFinite()) {
    return;
  }
  if (imu_tracker_ == nullptr) {
    imu_tracker_ = absl::make_unique<mapping::ImuTracker>(
        options_.imu_gravity_time_constant() > 0.
            ? options_.imu_gravity_time_constant()
            : options_.pose_extrapolator_options()
                  .constant_velocity()
                  .imu_gravity_time_constant(),
        imu_data.time);
  }
  if (imu_data.time < imu_tracker_->time()) return;
  imu_tracker_->Advance(imu_data.time);
  imu_tracker_->AddImuLinearAccelerationObservation(
      imu_data.linear_acceleration);
  imu_tracker_->AddImuAngularVelocityObservation(imu_data.angular_velocity);

  const Eigen::Quaterniond alignment = GravityAlignment();
  PlanarImuReading reading;
  reading.time = Seconds(imu_data.time);
  reading.acceleration = (alignment * imu_data.linear_acceleration).head<2>();
  reading.yaw_rate = (alignment * imu_data.angular_velocity).z();
  predictor_.AddImu(reading);
}

void AdaptiveLocalTrajectoryBuilder2D::AddOdometryData(
    const cartographer::sensor::OdometryData& odometry_data) {
  predictor_.AddOdometry(Seconds(odometry_data.time),
                         ToPose2(odometry_data.pose));
}

std::unique_ptr<AdaptiveLocalTrajectoryBuilder2D::MatchingResult>
AdaptiveLocalTrajectoryBuilder2D::AddRangeData(
    const std::string& sensor_id,
    const cartographer::sensor::TimedPointCloudData& range_data) {
  const cartographer::sensor::TimedPointCloudOriginData sweep =
      range_data_collator_.AddRangeData(sensor_id, range_data);
  if (sweep.ranges.empty()) return nullptr;
  if (options_.use_imu_data() && imu_tracker_ == nullptr) {
    LOG_EVERY_N(INFO, 100) << "waiting for the IMU";
    return nullptr;
  }
  const double seconds = Seconds(sweep.time);
  const double interval = has_pose_ ? seconds - last_seconds_ : 0.;
  if (has_pose_ && !(interval > 0.)) {
    LOG_EVERY_N(WARNING, 100) << "a scan that is not later is dropped";
    return nullptr;
  }
  const MotionPrediction prediction = predictor_.Predict(seconds);
  const Eigen::Quaterniond alignment = GravityAlignment();
  assembler_.Add(sweep, interval, prediction.motion, alignment);
  if (assembler_.num_sweeps() < options_.num_accumulated_range_data()) {
    return nullptr;
  }
  const AssembledScan scan = assembler_.Take();
  if (WaitsForOdometry(seconds, prediction)) return nullptr;
  return MatchAndInsert(sweep.time, prediction, scan, alignment);
}

bool AdaptiveLocalTrajectoryBuilder2D::WaitsForOdometry(
    const double seconds, const MotionPrediction& prediction) {
  if (!prediction.odometry_is_missing) {
    waits_ = false;
    return false;
  }
  if (!waits_) {
    waits_ = true;
    waits_since_ = seconds;
  }
  return seconds - waits_since_ < extension_.odometry().max_wait_after_gap();
}

PointCloud AdaptiveLocalTrajectoryBuilder2D::SelectFeatures(
    const PointCloud& cloud) const {
  std::vector<Eigen::Vector2d> points;
  points.reserve(cloud.size());
  for (const auto& point : cloud) {
    points.push_back(point.position.head<2>().cast<double>());
  }
  PointCloud features;
  for (const int i : front_end::SelectFeatures(
           ToAdaptiveFeatureOptions(extension_), points)) {
    features.push_back(cloud[i]);
  }
  return features;
}

std::unique_ptr<AdaptiveLocalTrajectoryBuilder2D::MatchingResult>
AdaptiveLocalTrajectoryBuilder2D::MatchAndInsert(
    const cartographer::common::Time time, const MotionPrediction& prediction,
    const AssembledScan& scan, const Eigen::Quaterniond& alignment) {
  const RangeData& gravity_aligned_range_data = scan.range_data;
  if (gravity_aligned_range_data.returns.empty()) {
    LOG_EVERY_N(WARNING, 100) << "a scan without returns is dropped";
    return nullptr;
  }
  const PointCloud cloud = cartographer::sensor::AdaptiveVoxelFilter(
      gravity_aligned_range_data.returns,
      options_.adaptive_voxel_filter_options());
  if (cloud.empty()) return nullptr;

  proto::MatchRecord record;
  record.set_builder(builder_number_);
  record.set_time(cartographer::common::ToUniversal(time));
  MatchScan(Seconds(time), prediction, cloud, &record);

  const Rigid2d pose = ToRigid2d(pose_);
  const Rigid3d local_pose =
      cartographer::transform::Embed3D(pose) * Rigid3d::Rotation(alignment);
  const auto pose_3d = cartographer::transform::Embed3D(pose.cast<float>());
  RangeData range_data_in_local = cartographer::sensor::TransformRangeData(
      gravity_aligned_range_data, pose_3d);
  auto insertion_result = MaybeInsert(
      time, range_data_in_local,
      cartographer::sensor::TransformPointCloud(scan.filling, pose_3d), cloud,
      local_pose, alignment);
  if (insertion_result != nullptr) predictor_.AddToMap();
  record.set_is_node(insertion_result != nullptr);
  if (recorder_ != nullptr) recorder_->Record(record);
  CountMatch(record);
  return absl::make_unique<MatchingResult>(
      MatchingResult{time, local_pose, std::move(range_data_in_local),
                     std::move(insertion_result)});
}

void AdaptiveLocalTrajectoryBuilder2D::MatchScan(
    const double seconds, const MotionPrediction& prediction,
    const PointCloud& cloud, proto::MatchRecord* const record) {
  const Pose2 last_pose = pose_;
  const auto submaps = active_submaps_.submaps();
  LocalMatch match;
  match.pose = last_pose * prediction.motion;
  if (!submaps.empty()) {
    // The older submap knows more.
    match = matcher_.Match(
        last_pose, prediction,
        extension_.features().enabled() ? SelectFeatures(cloud) : cloud,
        *submaps.front());
  }
  MatchedMotion matched;
  matched.motion = Between(last_pose, match.pose);
  matched.way_is_determined =
      WayIsDetermined(match.report.degeneracy, last_pose, match.pose);
  matched.turn_is_determined =
      match.report.degeneracy.rotation_weight > kDetermined;
  matched.covariance = InFrameOf(last_pose, match.report.covariance);
  matched.from_velocity =
      (prediction.source == PredictionSource::kConstantVelocity ||
       prediction.source == PredictionSource::kImu) &&
      !match.relocated;
  record->set_interval(has_pose_ ? seconds - last_seconds_ : 0.);
  const OdometryState state = predictor_.AddMatch(seconds, matched);
  pose_ = match.pose;
  last_seconds_ = seconds;
  has_pose_ = true;

  SetPose(match.pose, record);
  SetReport(match.report, record);
  SetPrediction(prediction.source, state, record);
  if (match.relocated) record->set_source(proto::MatchRecord::SEARCH);
  record->set_searched(match.searched);
  record->set_score(match.score);
  record->set_time_offset(predictor_.time_offset());
  SetCalibration(predictor_.calibration(), record);
}

std::unique_ptr<AdaptiveLocalTrajectoryBuilder2D::InsertionResult>
AdaptiveLocalTrajectoryBuilder2D::MaybeInsert(
    const cartographer::common::Time time, const RangeData& range_data_in_local,
    const PointCloud& filling_in_local, const PointCloud& cloud,
    const Rigid3d& local_pose, const Eigen::Quaterniond& alignment) {
  const auto submaps = active_submaps_.submaps();
  const bool is_young =
      submaps.empty() || submaps.front()->num_range_data() < kFirstScans;
  if (motion_filter_.IsSimilar(time, local_pose) && !is_young) return nullptr;
  RangeData completed = range_data_in_local;
  for (const auto& point : filling_in_local) completed.returns.push_back(point);
  auto result = absl::make_unique<InsertionResult>();
  for (auto& submap : active_submaps_.InsertRangeData(completed)) {
    result->insertion_submaps.push_back(submap);
  }
  auto data = std::make_shared<mapping::TrajectoryNode::Data>();
  data->time = time;
  data->gravity_alignment = alignment;
  data->filtered_gravity_aligned_point_cloud = cloud;
  data->local_pose = local_pose;
  result->constant_data = std::move(data);
  return result;
}

void AdaptiveLocalTrajectoryBuilder2D::RegisterMetrics(
    cartographer::metrics::FamilyFactory* const family_factory) {
  RegisterFrontEndMetrics(family_factory);
}

}  // namespace front_end
}  // namespace cartographer_ext
