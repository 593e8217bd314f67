// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/adaptive_local_trajectory_builder_2d.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "absl/types/optional.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/dropin/pose_conversion.h"
#include "cartographer_ext/front_end/dropin/front_end_metrics.h"
#include "cartographer_ext/front_end/dropin/matched_motion.h"
#include "cartographer_ext/front_end/insertion_count.h"
#include "cartographer_ext/front_end/match_record.h"
#include "cartographer_ext/match_record.pb.h"
#include "cartographer_ext/scan_matching/dropin/scan_evidence.h"
#include "cartographer_ext/uncertainty/step_errors.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::sensor::PointCloud;
using cartographer::sensor::RangeData;
using cartographer::transform::Rigid3d;

namespace mapping = cartographer::mapping;

// The first scans are inserted whether or not the robot moves: a single scan is
// not enough to match the next one against.
constexpr int kNumFirstScans = 5;

// A scan at a contested pose is kept out of the map while the last one is not
// farther away: a part of what narrow lasers see.
constexpr double kFarthestContested = 0.5;  // metres
constexpr double kWidestContested = 0.5;    // radians

// Seconds of sensor time between two lines in the log of the program.
constexpr double kSecondsBetweenLines = 60.;

PointCloud FeaturePoints(const AdaptiveFeatureOptions& options,
                         const PointCloud& cloud) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(cloud.size());
  for (const auto& point : cloud) {
    points.push_back(point.position.head<2>().cast<double>());
  }
  PointCloud features;
  for (const int i : SelectFeatures(options, points)) {
    features.push_back(cloud[i]);
  }
  return features;
}

AssembledScan Transform(const AssembledScan& scan, const Pose2& pose) {
  const auto pose_3d =
      cartographer::transform::Embed3D(ToRigid2d(pose).cast<float>());
  AssembledScan result;
  result.range_data =
      cartographer::sensor::TransformRangeData(scan.range_data, pose_3d);
  result.filling =
      cartographer::sensor::TransformPointCloud(scan.filling, pose_3d);
  return result;
}

}  // namespace

AdaptiveLocalTrajectoryBuilder2D::AdaptiveLocalTrajectoryBuilder2D(
    const mapping::proto::LocalTrajectoryBuilderOptions2D& options,
    const FrontEndOptions& extension,
    const std::vector<std::string>& expected_range_sensor_ids)
    : options_(options),
      extension_(extension),
      context_(PoseGraphContext::Current()),
      recorder_(context_ == nullptr ? nullptr : context_->Get<MatchRecorder>()),
      builder_number_(recorder_ == nullptr ? 0 : recorder_->AddBuilder()),
      submaps_(options.submaps_options()),
      motion_filter_(options.motion_filter_options()),
      range_data_collator_(expected_range_sensor_ids),
      assembler_(options,
                 WallFillingFor(
                     extension,
                     options.submaps_options().grid_options_2d().resolution()),
                 extension.smooth_ranges),
      beam_order_(options, extension.estimate_beam_order),
      predictor_(extension.prediction),
      matcher_(extension.search, options.ceres_scan_matcher_options()),
      log_(extension.log_directory, "nodes", RecordCsvHead()) {
  LOG_IF(ERROR, !log_.status().ok())
      << "cartographer_ext: no log of scans: " << log_.status();
}

AdaptiveLocalTrajectoryBuilder2D::~AdaptiveLocalTrajectoryBuilder2D() {
  LOG(INFO) << "cartographer_ext: local SLAM in the end " << ToText(counts_);
}

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
  cartographer::sensor::TimedPointCloudOriginData sweep =
      range_data_collator_.AddRangeData(sensor_id, range_data);
  if (!CanProcess(sweep)) return nullptr;

  const double seconds = Seconds(sweep.time);
  const double interval = has_pose_ ? seconds - last_seconds_ : 0.;
  beam_order_.SetTimes(range_data, interval, &sweep);
  field_of_view_.Advance(std::max(0., interval));
  for (const auto& range : sweep.ranges) {
    field_of_view_.Add(
        (range.point_time.position - sweep.origins.at(range.origin_index))
            .head<2>());
  }
  predictor_.SetFieldOfView(field_of_view_.angle());
  matcher_.SetFieldOfView(field_of_view_.angle());
  const MotionPrediction prediction = predictor_.Predict(seconds);

  const Eigen::Quaterniond alignment = GravityAlignment();
  assembler_.Add(sweep, interval, prediction.motion, alignment);
  if (assembler_.num_sweeps() < options_.num_accumulated_range_data()) {
    return nullptr;
  }
  const AssembledScan scan = assembler_.Take();
  if (MustWaitForOdometry(seconds, prediction)) return nullptr;

  const PointCloud cloud = cartographer::sensor::AdaptiveVoxelFilter(
      scan.range_data.returns, options_.adaptive_voxel_filter_options());
  if (cloud.empty()) {
    LOG_EVERY_N(WARNING, 100) << "a scan without returns is dropped";
    return nullptr;
  }
  const LocalMatch match = MatchScan(prediction, cloud);
  if (submaps_.Reference() != nullptr && !match.contested) {
    beam_order_.Learn(sweep, interval, prediction.motion, alignment, match.pose,
                      *submaps_.Reference());
  }
  const OdometryState odometry =
      UpdatePredictor(seconds, prediction, match, cloud);

  AssembledScan in_local = Transform(scan, pose_);
  auto node =
      MaybeInsert(sweep.time, in_local, cloud, alignment, match.contested);
  Record(sweep.time, interval, prediction, match, odometry, node != nullptr);
  return absl::make_unique<MatchingResult>(
      MatchingResult{sweep.time, LocalPose(alignment),
                     std::move(in_local.range_data), std::move(node)});
}

bool AdaptiveLocalTrajectoryBuilder2D::CanProcess(
    const cartographer::sensor::TimedPointCloudOriginData& sweep) {
  if (sweep.ranges.empty()) return false;
  if (options_.use_imu_data() && imu_tracker_ == nullptr) {
    LOG_EVERY_N(INFO, 100) << "waiting for the IMU";
    return false;
  }
  if (has_pose_ && !(Seconds(sweep.time) > last_seconds_)) {
    LOG_EVERY_N(WARNING, 100)
        << "a scan that is not later than the one before is dropped";
    return false;
  }
  return true;
}

bool AdaptiveLocalTrajectoryBuilder2D::MustWaitForOdometry(
    const double seconds, const MotionPrediction& prediction) {
  if (!prediction.odometry_pending) {
    is_waiting_ = false;
    return false;
  }
  if (!is_waiting_) {
    is_waiting_ = true;
    waiting_since_ = seconds;
  }
  return seconds - waiting_since_ < extension_.max_wait_after_gap;
}

LocalMatch AdaptiveLocalTrajectoryBuilder2D::MatchScan(
    const MotionPrediction& prediction, const PointCloud& cloud) {
  const auto submap = submaps_.Reference();
  if (submap == nullptr) {
    LocalMatch match;
    match.pose = pose_ * prediction.motion;
    return match;
  }
  return matcher_.Match(pose_, prediction,
                        extension_.match_features_only
                            ? FeaturePoints(extension_.features, cloud)
                            : cloud,
                        *submap);
}

OdometryState AdaptiveLocalTrajectoryBuilder2D::UpdatePredictor(
    const double seconds, const MotionPrediction& prediction,
    const LocalMatch& match, const PointCloud& cloud) {
  MatchedMotion matched = ToMatchedMotion(pose_, prediction, match, cloud);
  const auto submap = submaps_.Reference();
  if (submap != nullptr) {
    matched.scans_in_map = submap->num_range_data();
  }
  // Of all questions about this match; found when the first one is asked.
  absl::optional<scan_matching::PoseEvidence> evidence;
  if (submap != nullptr && !match.overrules_odometry) {
    matched.evidence = [&](const Pose2& error) {
      if (!evidence.has_value()) {
        evidence.emplace(match.pose, cloud, *submap->grid(),
                         scan_matching::PosePrecision::kCell);
      }
      // Along a corridor it fits as well on the other side.
      return std::min(evidence->Against(match.pose * error),
                      evidence->Against(match.pose * error.Inverse()));
    };
  }
  if (has_pose_) {
    predictor_.AddInnovation(
        InnovationOf(pose_, prediction, match, extension_.search.gate));
  }
  step_doubt_.Add(matched.motion, prediction.covariance, match.doubt,
                  prediction.bridges_gap);
  pose_ = match.pose;
  last_seconds_ = seconds;
  has_pose_ = true;
  return predictor_.AddMatch(seconds, matched);
}

Rigid3d AdaptiveLocalTrajectoryBuilder2D::LocalPose(
    const Eigen::Quaterniond& alignment) const {
  return cartographer::transform::Embed3D(ToRigid2d(pose_)) *
         Rigid3d::Rotation(alignment);
}

std::unique_ptr<AdaptiveLocalTrajectoryBuilder2D::InsertionResult>
AdaptiveLocalTrajectoryBuilder2D::MaybeInsert(
    const cartographer::common::Time time, const AssembledScan& scan_in_local,
    const PointCloud& cloud, const Eigen::Quaterniond& alignment,
    const bool is_contested) {
  const Rigid3d local_pose = LocalPose(alignment);
  const auto reference = submaps_.Reference();
  const bool is_first_scan =
      reference == nullptr || reference->num_range_data() < kNumFirstScans;
  if (!is_first_scan && ((is_contested && IsNearInsertion()) ||
                         motion_filter_.IsSimilar(time, local_pose))) {
    return nullptr;
  }
  RangeData with_filling = scan_in_local.range_data;
  for (const auto& point : scan_in_local.filling) {
    with_filling.returns.push_back(point);
  }
  auto result = absl::make_unique<InsertionResult>();
  for (auto& submap : Insert(with_filling)) {
    result->insertion_submaps.push_back(submap);
  }
  auto data = std::make_shared<mapping::TrajectoryNode::Data>();
  data->time = time;
  data->gravity_alignment = alignment;
  data->filtered_gravity_aligned_point_cloud = cloud;
  data->local_pose = local_pose;
  result->constant_data = std::move(data);
  predictor_.AddInsertion();
  const uncertainty::StepError error = step_doubt_.Take();
  if (context_ != nullptr && !error.is_usual()) {
    context_->Get<uncertainty::StepErrors>()->Add(
        cartographer::common::ToUniversal(time), error);
  }
  return result;
}

bool AdaptiveLocalTrajectoryBuilder2D::IsNearInsertion() const {
  const Pose2 motion = Between(insertion_pose_, pose_);
  return motion.translation().norm() < kFarthestContested &&
         std::abs(motion.theta) < kWidestContested;
}

LocalSubmaps::Submaps AdaptiveLocalTrajectoryBuilder2D::Insert(
    const RangeData& in_local) {
  const Pose2 since_insertion = Between(insertion_pose_, pose_);
  insertion_pose_ = pose_;
  const double spacing = options_.motion_filter_options().max_distance_meters();
  const double longest_gap =
      0.5 * options_.submaps_options().num_range_data() * spacing;
  if (longest_gap > 0. && since_insertion.translation().norm() > longest_gap &&
      !submaps_.Overlaps(in_local)) {
    return submaps_.InsertElsewhere(in_local);
  }
  return submaps_.Insert(in_local, InsertionCount(since_insertion, spacing));
}

void AdaptiveLocalTrajectoryBuilder2D::Record(
    const cartographer::common::Time time, const double interval,
    const MotionPrediction& prediction, const LocalMatch& match,
    const OdometryState odometry, const bool is_node) {
  proto::MatchRecord record;
  record.set_builder(builder_number_);
  record.set_time(cartographer::common::ToUniversal(time));
  record.set_interval(interval);
  SetPose(match.pose, &record);
  SetReport(match.report, &record);
  SetPrediction(prediction.source, odometry, &record);
  if (match.relocated) record.set_source(proto::MatchRecord::SEARCH);
  record.set_searched(match.searched);
  record.set_score(match.score);
  record.set_time_offset(predictor_.time_offset());
  SetCalibration(predictor_.calibration(), &record);
  SetGyroscope(predictor_.gyroscope(), &record);
  record.set_is_node(is_node);
  if (recorder_ != nullptr) recorder_->Record(record);
  CountMatch(record);
  Count(record);
}

void AdaptiveLocalTrajectoryBuilder2D::Count(const proto::MatchRecord& record) {
  counts_.Add(record);
  if (last_seconds_ - last_line_ >= kSecondsBetweenLines) {
    last_line_ = last_seconds_;
    LOG(INFO) << "cartographer_ext: local SLAM " << ToText(counts_);
  }
  if (!log_.is_on()) return;
  std::string bytes;
  AppendRecord(record, &bytes);
  log_.Append(RecordCsvRows({record}), bytes);
  LOG_IF(ERROR, !log_.is_on())
      << "cartographer_ext: the log of scans ends: " << log_.status();
}

void AdaptiveLocalTrajectoryBuilder2D::RegisterMetrics(
    cartographer::metrics::FamilyFactory* const family_factory) {
  RegisterFrontEndMetrics(family_factory);
}

}  // namespace front_end
}  // namespace cartographer_ext
