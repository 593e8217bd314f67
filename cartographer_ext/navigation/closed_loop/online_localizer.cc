// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/online_localizer.h"

#include <map>
#include <set>
#include <utility>

#include "Eigen/Geometry"
#include "absl/memory/memory.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/slam/scan_conversion.h"
#include "cartographer_ext/slam/starting_state.h"

namespace cartographer_ext {
namespace navigation {
namespace {

using cartographer::mapping::MapBuilderInterface;
using cartographer::mapping::TrajectoryBuilderInterface;
using cartographer::transform::Rigid3d;
using SensorId = TrajectoryBuilderInterface::SensorId;

constexpr char kScanId[] = "scan";
constexpr char kOdometryId[] = "odom";
const absl::Duration kPatience = absl::Seconds(120);

Rigid3d ToRigid(const Pose2& pose) {
  return Rigid3d(Eigen::Vector3d(pose.x, pose.y, 0.),
                 Eigen::Quaterniond(
                     Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ())));
}

}  // namespace

class OnlineLocalizer::Implementation {
 public:
  explicit Implementation(const evaluation::SlamConfiguration& configuration)
      : sensors_(configuration.sensors),
        optimize_every_n_nodes_(
            configuration.map_builder_options.pose_graph_options()
                .optimize_every_n_nodes()),
        map_builder_(cartographer::mapping::CreateMapBuilder(
            configuration.map_builder_options)) {}

  ~Implementation() {
    if (builder_ == nullptr) return;
    map_builder_->FinishTrajectory(trajectory_id_);
    map_builder_->pose_graph()->RunFinalOptimization();
  }

  absl::Status Start(const evaluation::SlamConfiguration& configuration,
                     const std::string& pbstream_filename,
                     const Pose2& initial_pose) {
    evaluation::StartingState state;
    state.filename = pbstream_filename;
    const auto ids = evaluation::LoadStartingState(state, map_builder_.get());
    if (!ids.ok()) return ids.status();
    auto options = configuration.trajectory_builder_options;
    const auto nodes = map_builder_->pose_graph()->GetTrajectoryNodePoses();
    const absl::Status status = evaluation::SetInitialPose(
        initial_pose, (*nodes.begin()).id.trajectory_id,
        *map_builder_->pose_graph(), &options);
    if (!status.ok()) return status;
    std::set<SensorId> ids_of_sensors = {
        {SensorId::SensorType::RANGE, kScanId}};
    if (sensors_.use_odometry) {
      ids_of_sensors.insert({SensorId::SensorType::ODOMETRY, kOdometryId});
    }
    trajectory_id_ = map_builder_->AddTrajectoryBuilder(
        ids_of_sensors, options,
        [this](int /*trajectory_id*/, const cartographer::common::Time time,
               const Rigid3d& local_pose,
               const cartographer::sensor::RangeData& /*range_data*/,
               const std::unique_ptr<
                   const TrajectoryBuilderInterface::InsertionResult>
                   inserted) {
          matched_time_ = evaluation::FromHostTime(time);
          local_from_robot_ = local_pose;
          matched_ = true;
          if (inserted != nullptr) ++nodes_since_optimization_;
        });
    builder_ = map_builder_->GetTrajectoryBuilder(trajectory_id_);
    auto* const pose_graph = map_builder_->pose_graph();
    map_from_local_ = pose_graph->GetLocalToGlobalTransform(trajectory_id_);
    pose_graph->SetGlobalSlamOptimizationCallback(
        [this, pose_graph](
            const std::map<int, cartographer::mapping::SubmapId>& /*submaps*/,
            const std::map<int, cartographer::mapping::NodeId>& /*nodes*/) {
          const Rigid3d transform =
              pose_graph->GetLocalToGlobalTransform(trajectory_id_);
          absl::MutexLock lock(&mutex_);
          map_from_local_ = transform;
          ++optimizations_;
        });
    return absl::OkStatus();
  }

  void Add(const io::OdometryReading& reading) {
    if (!sensors_.use_odometry) return;
    builder_->AddSensorData(
        kOdometryId,
        cartographer::sensor::OdometryData{evaluation::ToHostTime(reading.time),
                                           ToRigid(reading.pose)});
    WaitForOptimization();
  }

  void Add(const io::LaserScan& scan) {
    const auto data = evaluation::ToTimedPointCloudData(
        scan, sensors_.min_range, sensors_.max_range);
    if (data.ranges.empty()) return;
    builder_->AddSensorData(kScanId, data);
    WaitForOptimization();
  }

  absl::optional<PoseEstimate> Latest() const {
    if (!matched_) return absl::nullopt;
    absl::MutexLock lock(&mutex_);
    PoseEstimate estimate;
    estimate.time = matched_time_;
    estimate.map_from_robot =
        evaluation::ToPlanarPose(map_from_local_ * local_from_robot_);
    return estimate;
  }

  int timeouts() const { return timeouts_; }

 private:
  // The host optimises after the node with which their number exceeds this.
  void WaitForOptimization() {
    if (optimize_every_n_nodes_ <= 0 ||
        nodes_since_optimization_ <= optimize_every_n_nodes_) {
      return;
    }
    nodes_since_optimization_ = 0;
    absl::MutexLock lock(&mutex_);
    const auto done = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
      return optimizations_ > awaited_optimizations_;
    };
    if (!mutex_.AwaitWithTimeout(absl::Condition(&done), kPatience)) {
      ++timeouts_;
    }
    awaited_optimizations_ = optimizations_;
  }

  const evaluation::SensorSettings sensors_;
  const int optimize_every_n_nodes_;
  mutable absl::Mutex mutex_;
  Rigid3d map_from_local_ ABSL_GUARDED_BY(mutex_);
  int optimizations_ ABSL_GUARDED_BY(mutex_) = 0;
  int awaited_optimizations_ ABSL_GUARDED_BY(mutex_) = 0;
  // Set by a callback within AddSensorData, on the thread of the caller.
  bool matched_ = false;
  io::TimeNs matched_time_ = 0;
  Rigid3d local_from_robot_;
  int nodes_since_optimization_ = 0;
  int timeouts_ = 0;
  int trajectory_id_ = 0;
  TrajectoryBuilderInterface* builder_ = nullptr;
  // Declared last, so that its threads end before the members that their
  // callbacks use are destroyed.
  const std::unique_ptr<MapBuilderInterface> map_builder_;
};

absl::StatusOr<std::unique_ptr<OnlineLocalizer>> OnlineLocalizer::Create(
    const evaluation::SlamConfiguration& configuration,
    const std::string& pbstream_filename, const Pose2& initial_pose) {
  auto implementation = absl::make_unique<Implementation>(configuration);
  const absl::Status status =
      implementation->Start(configuration, pbstream_filename, initial_pose);
  if (!status.ok()) return status;
  return absl::WrapUnique(new OnlineLocalizer(std::move(implementation)));
}

OnlineLocalizer::OnlineLocalizer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

OnlineLocalizer::~OnlineLocalizer() = default;

void OnlineLocalizer::Add(const io::OdometryReading& reading) {
  implementation_->Add(reading);
}

void OnlineLocalizer::Add(const io::LaserScan& scan) {
  implementation_->Add(scan);
}

absl::optional<PoseEstimate> OnlineLocalizer::Latest() const {
  return implementation_->Latest();
}

int OnlineLocalizer::timeouts() const { return implementation_->timeouts(); }

}  // namespace navigation
}  // namespace cartographer_ext
