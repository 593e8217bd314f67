// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Local SLAM of one trajectory: every scan is matched against the older of the
// two submaps under construction and then, if the robot has moved, inserted
// into both. No knowledge of loop closures comes back to it.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_LOCAL_TRAJECTORY_BUILDER_2D_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_LOCAL_TRAJECTORY_BUILDER_2D_H_

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "absl/types/optional.h"
#include "cartographer/common/time.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/range_accumulator.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/range_data_collator.h"
#include "cartographer/mapping/pose_extrapolator.h"
#include "cartographer/mapping/proto/local_trajectory_builder_options_2d.pb.h"
#include "cartographer/mapping/trajectory_node.h"
#include "cartographer/metrics/family_factory.h"
#include "cartographer/sensor/imu_data.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/sensor/odometry_data.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/sensor/timed_point_cloud_data.h"
#include "cartographer/transform/rigid_transform.h"

namespace cartographer {
namespace mapping {

// Data must come in order of time, one call at a time.
class LocalTrajectoryBuilder2D {
 public:
  struct InsertionResult {
    std::shared_ptr<const TrajectoryNode::Data> constant_data;
    std::vector<std::shared_ptr<const Submap2D>> insertion_submaps;
  };
  struct MatchingResult {
    common::Time time;
    transform::Rigid3d local_pose;  // (local <- tracking)
    sensor::RangeData range_data_in_local;
    // Null where the robot has hardly moved since the last insertion.
    std::unique_ptr<const InsertionResult> insertion_result;
  };

  explicit LocalTrajectoryBuilder2D(
      const proto::LocalTrajectoryBuilderOptions2D& options,
      const std::vector<std::string>& expected_range_sensor_ids);
  ~LocalTrajectoryBuilder2D();
  LocalTrajectoryBuilder2D(const LocalTrajectoryBuilder2D&) = delete;
  LocalTrajectoryBuilder2D& operator=(const LocalTrajectoryBuilder2D&) = delete;

  // Null as long as nothing was matched: scans are still being accumulated or
  // waited for, the IMU has not delivered yet, or no point was left.
  std::unique_ptr<MatchingResult> AddRangeData(
      const std::string& sensor_id,
      const sensor::TimedPointCloudData& range_data);
  // Ignored, with a warning, unless the options use the IMU.
  void AddImuData(const sensor::ImuData& imu_data);
  void AddOdometryData(const sensor::OdometryData& odometry_data);

  static void RegisterMetrics(metrics::FamilyFactory* family_factory);

 private:
  // What one scan match works on.
  struct Scan {
    common::Time time;
    Eigen::Quaterniond gravity_alignment;  // (gravity aligned <- tracking)
    sensor::RangeData range_data;          // gravity aligned
    sensor::PointCloud cloud;              // returns, thinned for matching
  };

  void InitializeExtrapolator(common::Time time);

  // (local <- tracking) at the time of every point.
  std::vector<transform::Rigid3f> ExtrapolatePoses(
      const sensor::TimedPointCloudOriginData& sweep);
  std::unique_ptr<MatchingResult> MatchAndInsert(const Scan& scan);
  // (local <- gravity aligned)
  transform::Rigid2d Match(const transform::Rigid2d& prediction,
                           const sensor::PointCloud& cloud);
  std::unique_ptr<InsertionResult> Insert(const Scan& scan,
                                          const MatchingResult& matched);
  void ReportSpeed(common::Time time);

  // In the order in which a scan passes them.
  const proto::LocalTrajectoryBuilderOptions2D options_;
  RangeDataCollator range_data_collator_;
  // Null until the first scan, or with an IMU until its first reading.
  std::unique_ptr<PoseExtrapolator> extrapolator_;
  RangeAccumulator accumulator_;
  scan_matching::RealTimeCorrelativeScanMatcher2D
      real_time_correlative_scan_matcher_;
  scan_matching::CeresScanMatcher2D ceres_scan_matcher_;
  MotionFilter motion_filter_;
  ActiveSubmaps2D active_submaps_;

  // For metrics only.
  struct Clocks {
    common::Time sensor;
    std::chrono::steady_clock::time_point wall;
    double cpu_seconds;
  };
  absl::optional<Clocks> last_clocks_;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_LOCAL_TRAJECTORY_BUILDER_2D_H_
