// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Each step of the host's local SLAM against the step that the real
// Cartographer made from the same state. Whole runs with the online
// correlative matcher part by chance, because they amplify every rounding (see
// host_parity_test); here every node begins from the pose and the gravity
// alignment that the real system gave to the node before, with submaps of scans
// at the real system's poses, so that nothing adds up.

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/mapping/2d/submap_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/ceres_scan_matcher_2d.h"
#include "cartographer/mapping/internal/2d/scan_matching/real_time_correlative_scan_matcher_2d.h"
#include "cartographer/mapping/internal/motion_filter.h"
#include "cartographer/mapping/internal/range_data_collator.h"
#include "cartographer/mapping/pose_extrapolator.h"
#include "cartographer/sensor/internal/voxel_filter.h"
#include "cartographer/sensor/range_data.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/slam/scan_conversion.h"
#include "gtest/gtest.h"
#include "tests/slam/csail_made.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using ::cartographer::mapping::MotionFilter;
using ::cartographer::mapping::PoseExtrapolator;
using ::cartographer::transform::Embed3D;
using ::cartographer::transform::Project2D;
using ::cartographer::transform::Rigid2d;
using ::cartographer::transform::Rigid3d;
using ::cartographer::transform::Rigid3f;
using Options = ::cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D;

// Readers round stamps differently.
constexpr io::TimeNs kStampTolerance = 100000;

struct StoredNode {
  Rigid3d local_pose;
  Eigen::Quaterniond gravity_alignment;
};

std::map<io::TimeNs, StoredNode> StoredNodes(const io::Pbstream& pbstream) {
  std::map<io::TimeNs, StoredNode> nodes;
  for (const auto& node : pbstream.nodes) {
    const auto& data = node.node_data();
    nodes[FromHostTicks(data.timestamp())] = {
        cartographer::transform::ToRigid3(data.local_pose()),
        cartographer::transform::ToEigen(data.gravity_alignment())};
  }
  return nodes;
}

class Stepper {
 public:
  Stepper(const Options& options, std::map<io::TimeNs, StoredNode> nodes)
      : options_(options),
        submaps_(options.submaps_options()),
        correlative_(options.real_time_correlative_scan_matcher_options()),
        ceres_(options.ceres_scan_matcher_options()),
        nodes_(std::move(nodes)) {}

  void operator()(const io::ImuReading&) {}

  void operator()(const io::OdometryReading& reading) {
    if (extrapolator_ == nullptr) return;
    const Pose2& pose = reading.pose;
    extrapolator_->AddOdometryData(cartographer::sensor::OdometryData{
        ToHostTime(reading.time),
        Embed3D(Rigid2d({pose.x, pose.y}, pose.theta))});
  }

  void operator()(const io::LaserScan& scan) {
    const auto time = ToHostTime(scan.time);
    if (extrapolator_ == nullptr) Start(time);
    // Its yaw has no meaning (there is no IMU) but decides in which frame the
    // cloud is thinned out.
    const Eigen::Quaterniond estimated =
        extrapolator_->EstimateGravityOrientation(time);
    const Rigid3d gravity_alignment =
        Rigid3d::Rotation(estimated * from_estimated_);
    const Rigid3d extrapolated = extrapolator_->ExtrapolatePose(time);
    const auto range_data = LimitAndAlign(scan, extrapolated.cast<float>(),
                                          gravity_alignment.cast<float>());
    const Rigid3d matched =
        Embed3D(Match(Project2D(extrapolated * gravity_alignment.inverse()),
                      cartographer::sensor::AdaptiveVoxelFilter(
                          range_data.returns,
                          options_.adaptive_voxel_filter_options()))) *
        gravity_alignment;

    const auto node = nodes_.lower_bound(scan.time - kStampTolerance);
    const bool is_node =
        node != nodes_.end() && node->first <= scan.time + kStampTolerance;
    if (BecomesNode(time, matched) == is_node) ++alike_decisions;
    ++scans;
    if (!is_node) {
      extrapolator_->AddPose(time, matched);
      return;
    }
    const Rigid3d& stored = node->second.local_pose;
    Compare(Project2D(stored), Project2D(matched));
    from_estimated_ = estimated.inverse() * node->second.gravity_alignment;
    extrapolator_->AddPose(time, stored);
    submaps_.InsertRangeData(cartographer::sensor::TransformRangeData(
        range_data,
        Embed3D(
            Project2D(stored * gravity_alignment.inverse()).cast<float>())));
    last_node_time_ = time;
    last_node_pose_ = stored;
  }

  int scans = 0;
  int alike_decisions = 0;  // of the motion filter
  int nodes = 0;
  int alike_translation = 0;
  int alike = 0;

 private:
  void Start(const cartographer::common::Time time) {
    const auto& options =
        options_.pose_extrapolator_options().constant_velocity();
    extrapolator_ = absl::make_unique<PoseExtrapolator>(
        cartographer::common::FromSeconds(options.pose_queue_duration()),
        options.imu_gravity_time_constant());
    extrapolator_->AddPose(time, Rigid3d::Identity());
  }

  // The points of the scan, all of one stamp, in the gravity-aligned frame.
  cartographer::sensor::RangeData LimitAndAlign(
      const io::LaserScan& scan, const Rigid3f& pose,
      const Rigid3f& gravity_alignment) {
    cartographer::sensor::RangeData result{pose.translation(), {}, {}};
    const auto sweep =
        collator_.AddRangeData("scan", ToTimedPointCloudData(scan, 0.1, 80.));
    for (const auto& range : sweep.ranges) {
      const Eigen::Vector3f hit = pose * range.point_time.position;
      const Eigen::Vector3f ray = hit - result.origin;
      const float length = ray.norm();
      if (length < options_.min_range()) continue;
      if (length <= options_.max_range()) {
        result.returns.push_back({hit});
      } else {
        result.misses.push_back(
            {result.origin +
             options_.missing_data_ray_length() / length * ray});
      }
    }
    result = cartographer::sensor::TransformRangeData(
        result, gravity_alignment * pose.inverse());
    result.returns = cartographer::sensor::VoxelFilter(
        result.returns, options_.voxel_filter_size());
    result.misses = cartographer::sensor::VoxelFilter(
        result.misses, options_.voxel_filter_size());
    return result;
  }

  Rigid2d Match(const Rigid2d& prediction,
                const cartographer::sensor::PointCloud& cloud) const {
    if (submaps_.submaps().empty()) return prediction;
    const auto& grid = *submaps_.submaps().front()->grid();
    Rigid2d initial = prediction;
    correlative_.Match(prediction, cloud, grid, &initial);
    Rigid2d matched;
    ceres::Solver::Summary summary;
    ceres_.Match(prediction.translation(), initial, cloud, grid, &matched,
                 &summary);
    return matched;
  }

  bool BecomesNode(const cartographer::common::Time time,
                   const Rigid3d& pose) const {
    MotionFilter filter(options_.motion_filter_options());
    if (nodes > 0) filter.IsSimilar(last_node_time_, last_node_pose_);
    return !filter.IsSimilar(time, pose);
  }

  void Compare(const Rigid2d& stored, const Rigid2d& matched) {
    const Rigid2d difference = stored.inverse() * matched;
    ++nodes;
    if (difference.translation().norm() > 0.02) return;
    ++alike_translation;
    constexpr double kAngle = 0.2 * M_PI / 180.;
    if (std::abs(difference.normalized_angle()) <= kAngle) ++alike;
  }

  const Options options_;
  cartographer::mapping::RangeDataCollator collator_{
      std::vector<std::string>{"scan"}};
  cartographer::mapping::ActiveSubmaps2D submaps_;
  const cartographer::mapping::scan_matching::RealTimeCorrelativeScanMatcher2D
      correlative_;
  const cartographer::mapping::scan_matching::CeresScanMatcher2D ceres_;
  std::unique_ptr<PoseExtrapolator> extrapolator_;
  // What the extrapolator's estimate lacks of the stored alignment.
  Eigen::Quaterniond from_estimated_ = Eigen::Quaterniond::Identity();
  const std::map<io::TimeNs, StoredNode> nodes_;
  cartographer::common::Time last_node_time_;
  Rigid3d last_node_pose_;
};

using HostParityStepTest = CsailMadeTest;

TEST_F(HostParityStepTest, LocalSlamOnCsail) {
  Stepper stepper(
      configuration_.trajectory_builder_options.trajectory_builder_2d_options(),
      StoredNodes(pbstream_));
  io::SensorEvent event;
  while (true) {
    const auto more = source_->Next(&event);
    ASSERT_TRUE(more.ok()) << more.status();
    if (!*more) break;
    absl::visit(std::ref(stepper), event);
  }
  EXPECT_EQ(stepper.scans, 1988);
  EXPECT_EQ(stepper.nodes, 1778);
  EXPECT_GE(stepper.alike_decisions, 0.99 * stepper.scans);
  EXPECT_GE(stepper.alike_translation, 0.99 * stepper.nodes);
  EXPECT_GE(stepper.alike, 0.99 * stepper.nodes);
  RecordProperty("alike", stepper.alike);
  RecordProperty("alike_decisions", stepper.alike_decisions);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
