// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// LocalTrajectoryBuilder2D for options with our block. What is done with a scan
// is the stock builder's: points are collated, filtered, matched against the
// older of two submaps and inserted into both when the robot has moved. What
// is different:
//
//  1. Prediction (motion_predictor.h): odometry over the very interval, at the
//     stamps of the scans less the clock offset, or IMU, or velocity, with a
//     covariance; odometry that is at fault is found out and left aside.
//  2. Match (local_matcher.h): scan and prediction weighed by what each knows,
//     direction by direction; a correlative search only where the prediction
//     is in doubt.
//  3. Evidence: one record a scan (match_recorder.h), and metrics.
//
// A gap in the scans is bridged by the motion over the gap. If odometry is
// about to come, scans wait for it, that is, they are left out; without
// odometry and IMU no motion is made up, and the search looks around.
#ifndef CARTOGRAPHER_EXT_FRONT_END_DROPIN_ADAPTIVE_LOCAL_TRAJECTORY_BUILDER_2D_H_
#define CARTOGRAPHER_EXT_FRONT_END_DROPIN_ADAPTIVE_LOCAL_TRAJECTORY_BUILDER_2D_H_

#include <memory>
#include <string>
#include <vector>

#include "Eigen/Geometry"
#include "cartographer/common/time.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/imu_tracker.h"
#include "cartographer/mapping/internal/2d/local_trajectory_builder_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/range_data_collator.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/front_end/dropin/local_matcher.h"
#include "cartographer_ext/front_end/dropin/scan_assembler.h"
#include "cartographer_ext/front_end/match_recorder.h"
#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end_options.pb.h"
#include "cartographer_ext/match_record.pb.h"

namespace cartographer_ext {
namespace front_end {

// Data must come in order of time, one call at a time.
class AdaptiveLocalTrajectoryBuilder2D {
 public:
  using InsertionResult =
      cartographer::mapping::LocalTrajectoryBuilder2D::InsertionResult;
  using MatchingResult =
      cartographer::mapping::LocalTrajectoryBuilder2D::MatchingResult;

  AdaptiveLocalTrajectoryBuilder2D(
      const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D&
          options,
      const proto::FrontEndOptions& extension,
      const std::vector<std::string>& expected_range_sensor_ids);
  ~AdaptiveLocalTrajectoryBuilder2D();
  AdaptiveLocalTrajectoryBuilder2D(const AdaptiveLocalTrajectoryBuilder2D&) =
      delete;
  AdaptiveLocalTrajectoryBuilder2D& operator=(
      const AdaptiveLocalTrajectoryBuilder2D&) = delete;

  // As the stock builder: null if nothing was matched.
  std::unique_ptr<MatchingResult> AddRangeData(
      const std::string& sensor_id,
      const cartographer::sensor::TimedPointCloudData& range_data);
  // Ignored, with a warning, unless the options use the IMU.
  void AddImuData(const cartographer::sensor::ImuData& imu_data);
  void AddOdometryData(const cartographer::sensor::OdometryData& odometry_data);

  static void RegisterMetrics(
      cartographer::metrics::FamilyFactory* family_factory);

 private:
  // Since the first data of any kind.
  double Seconds(cartographer::common::Time time);
  // (gravity aligned <- tracking), without turn about the vertical.
  Eigen::Quaterniond GravityAlignment() const;
  cartographer::sensor::PointCloud SelectFeatures(
      const cartographer::sensor::PointCloud& cloud) const;

  // Whether a scan that follows a gap had better be left out, because odometry
  // will tell of the gap soon.
  bool WaitsForOdometry(double seconds, const MotionPrediction& prediction);
  std::unique_ptr<MatchingResult> MatchAndInsert(
      cartographer::common::Time time, const MotionPrediction& prediction,
      const AssembledScan& scan, const Eigen::Quaterniond& alignment);
  // Moves the pose, learns from the match, fills in the record.
  void MatchScan(double seconds, const MotionPrediction& prediction,
                 const cartographer::sensor::PointCloud& cloud,
                 proto::MatchRecord* record);
  std::unique_ptr<InsertionResult> MaybeInsert(
      cartographer::common::Time time,
      const cartographer::sensor::RangeData& range_data_in_local,
      const cartographer::sensor::PointCloud& filling_in_local,
      const cartographer::sensor::PointCloud& cloud,
      const cartographer::transform::Rigid3d& local_pose,
      const Eigen::Quaterniond& alignment);

  const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D options_;
  const proto::FrontEndOptions extension_;
  // Of the scope of construction; both null without one.
  const std::shared_ptr<PoseGraphContext> context_;
  MatchRecorder* const recorder_;
  const int builder_number_;
  cartographer::mapping::ActiveSubmaps2D active_submaps_;
  cartographer::mapping::MotionFilter motion_filter_;
  cartographer::mapping::RangeDataCollator range_data_collator_;
  ScanAssembler assembler_;
  MotionPredictor predictor_;
  LocalMatcher matcher_;
  // Null until the first reading.
  std::unique_ptr<cartographer::mapping::ImuTracker> imu_tracker_;

  bool has_start_ = false;
  cartographer::common::Time start_;
  bool has_pose_ = false;
  double last_seconds_ = 0.;
  Pose2 pose_;  // (local <- gravity-aligned robot) at the last match
  // Since when scans have been left out behind a gap.
  bool waits_ = false;
  double waits_since_ = 0.;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_ADAPTIVE_LOCAL_TRAJECTORY_BUILDER_2D_H_
