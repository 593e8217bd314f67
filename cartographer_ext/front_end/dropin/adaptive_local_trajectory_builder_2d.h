// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// LocalTrajectoryBuilder2D for options with our block. The stages of a scan are
// those of the stock builder, and AddRangeData() shows them in order: collate,
// predict, assemble, filter, match, update the predictor, insert, record. The
// differences:
//
//  1. Prediction (motion_predictor.h): odometry over exactly the interval
//     between the scans, at their stamps less the clock offset, or IMU, or
//     velocity, with a covariance; faulty odometry is detected and not used.
//  2. Match (local_matcher.h): scan and prediction are weighted by their
//     information, direction by direction; a correlative search only where the
//     prediction is doubtful.
//  3. Submaps (local_submaps.h): as in stock, but a scan far from them begins
//     new ones.
//  4. Evidence: one record per scan (match_recorder.h), and metrics.
//
// A gap in the scans is bridged by the motion over the gap. While odometry for
// the gap is pending, scans are dropped, for a limited time; without odometry
// and IMU no motion is assumed, and the match searches around the last pose.
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
#include "cartographer_ext/common/record_log.h"
#include "cartographer_ext/front_end/dropin/beam_order.h"
#include "cartographer_ext/front_end/dropin/local_matcher.h"
#include "cartographer_ext/front_end/dropin/local_submaps.h"
#include "cartographer_ext/front_end/dropin/scan_assembler.h"
#include "cartographer_ext/front_end/front_end_options.h"
#include "cartographer_ext/front_end/match_counts.h"
#include "cartographer_ext/front_end/match_recorder.h"
#include "cartographer_ext/front_end/motion_predictor.h"
#include "cartographer_ext/front_end/point_cloud/field_of_view.h"
#include "cartographer_ext/front_end/step_doubt.h"

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
      const FrontEndOptions& extension,
      const std::vector<std::string>& expected_range_sensor_ids);
  ~AdaptiveLocalTrajectoryBuilder2D();
  AdaptiveLocalTrajectoryBuilder2D(const AdaptiveLocalTrajectoryBuilder2D&) =
      delete;
  AdaptiveLocalTrajectoryBuilder2D& operator=(
      const AdaptiveLocalTrajectoryBuilder2D&) = delete;

  // Adds a sweep of a range sensor. Returns the pose of the scan, and the node
  // if the scan was inserted into the submaps; null if the sweep did not
  // complete a scan or the scan could not be matched.
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
  // (gravity aligned <- tracking), without rotation about the vertical.
  Eigen::Quaterniond GravityAlignment() const;

  // The stages of AddRangeData().
  bool CanProcess(const cartographer::sensor::TimedPointCloudOriginData& sweep);
  // Whether to drop a scan after a gap, because odometry for the gap is
  // pending.
  bool MustWaitForOdometry(double seconds, const MotionPrediction& prediction);
  // Against the submap to match against; the prediction itself without one.
  LocalMatch MatchScan(const MotionPrediction& prediction,
                       const cartographer::sensor::PointCloud& cloud);
  // Moves the pose to that of the match and updates the predictor.
  OdometryState UpdatePredictor(double seconds,
                                const MotionPrediction& prediction,
                                const LocalMatch& match,
                                const cartographer::sensor::PointCloud& cloud);
  // (local <- tracking) at the last match.
  cartographer::transform::Rigid3d LocalPose(
      const Eigen::Quaterniond& alignment) const;
  // Null if the robot has hardly moved since the last insertion.
  std::unique_ptr<InsertionResult> MaybeInsert(
      cartographer::common::Time time, const AssembledScan& scan_in_local,
      const cartographer::sensor::PointCloud& cloud,
      const Eigen::Quaterniond& alignment, bool is_contested);
  // Whether a scan may be left out of the map.
  bool IsNearInsertion() const;
  // As often as it stands for (insertion_count.h). After a gap of half a submap
  // and more without overlap it lies elsewhere (local_submaps.h).
  LocalSubmaps::Submaps Insert(const cartographer::sensor::RangeData& in_local);
  void Record(cartographer::common::Time time, double interval,
              const MotionPrediction& prediction, const LocalMatch& match,
              OdometryState odometry, bool is_node);
  // Into the counts and, where the options say so, into a log; a line about the
  // counts now and then.
  void Count(const proto::MatchRecord& record);

  const cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D options_;
  const FrontEndOptions extension_;
  // Of the scope of construction; both null without one.
  const std::shared_ptr<PoseGraphContext> context_;
  MatchRecorder* const recorder_;
  const int builder_number_;
  LocalSubmaps submaps_;
  cartographer::mapping::MotionFilter motion_filter_;
  cartographer::mapping::RangeDataCollator range_data_collator_;
  ScanAssembler assembler_;
  BeamOrderLearner beam_order_;
  MotionPredictor predictor_;
  FieldOfView field_of_view_;
  LocalMatcher matcher_;
  // Null until the first reading.
  std::unique_ptr<cartographer::mapping::ImuTracker> imu_tracker_;

  bool has_start_ = false;
  cartographer::common::Time start_;
  bool has_pose_ = false;
  double last_seconds_ = 0.;
  Pose2 pose_;            // (local <- gravity-aligned robot) at the last match
  Pose2 insertion_pose_;  // the same at the last scan that was inserted
  StepDoubt step_doubt_;  // since the last node
  // Scans are dropped after a gap until odometry has caught up.
  bool is_waiting_ = false;
  double waiting_since_ = 0.;

  MatchCounts counts_;
  double last_line_ = 0.;  // seconds, when the counts were logged
  RecordLog log_;
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_DROPIN_ADAPTIVE_LOCAL_TRAJECTORY_BUILDER_2D_H_
