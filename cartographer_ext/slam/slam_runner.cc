// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/slam_runner.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/front_end/match_recorder.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/slam/back_end_metrics.h"
#include "cartographer_ext/slam/metrics_collector.h"
#include "cartographer_ext/slam/online_poses.h"
#include "cartographer_ext/slam/resource_usage.h"
#include "cartographer_ext/slam/scan_conversion.h"
#include "cartographer_ext/slam/scan_trajectory.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::MapBuilderInterface;
using cartographer::mapping::PoseGraphInterface;
using cartographer::mapping::TrajectoryBuilderInterface;
using cartographer::mapping::proto::TrajectoryBuilderOptions;
using SensorId = TrajectoryBuilderInterface::SensorId;

constexpr char kScanId[] = "scan";
constexpr char kOdometryId[] = "odom";
constexpr char kImuId[] = "imu";

SensorId OdometrySensor() {
  return {SensorId::SensorType::ODOMETRY, kOdometryId};
}

SensorId ImuSensor() { return {SensorId::SensorType::IMU, kImuId}; }

// Decision records kept, about 400 bytes each.
constexpr size_t kMaxDecisions = 2000000;
// Records of matched scans kept, about 300 bytes each.
constexpr size_t kMaxMatches = 2000000;
// Longest wait for a queue that does not move.
constexpr std::chrono::seconds kPatience(30);

double SecondsSince(const std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
      .count();
}

cartographer::transform::Rigid3d ToHostPose(const Pose2& pose) {
  return cartographer::transform::Rigid3d(
      Eigen::Vector3d(pose.x, pose.y, 0.),
      Eigen::Quaterniond(
          Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ())));
}

// Gives one trajectory builder the events of a source.
class Feeder {
 public:
  Feeder(const SensorSettings& settings, const std::set<SensorId>& sensors,
         TrajectoryBuilderInterface* const builder, SlamRun* const run)
      : settings_(settings),
        use_odometry_(sensors.count(OdometrySensor()) > 0),
        use_imu_(sensors.count(ImuSensor()) > 0),
        builder_(builder),
        run_(run) {
    for (const SensorId& sensor : sensors) {
      if (sensor.type != SensorId::SensorType::RANGE) continue;
      last_scans_[sensor.id] = cartographer::common::Time::min();
    }
  }

  void operator()(const io::LaserScan& scan) {
    const auto data =
        ToTimedPointCloudData(scan, settings_.min_range, settings_.max_range);
    const std::string id =
        last_scans_.count(scan.sensor_id) > 0 ? scan.sensor_id : kScanId;
    if (data.ranges.empty() || !Later(scan.time, &last_scans_.at(id))) {
      ++run_->scans_left_out;
      return;
    }
    if (run_->scans == 0) first_scan_ = scan.time;
    ++run_->scans;
    run_->sensor_seconds = io::ToSeconds(scan.time - first_scan_);
    builder_->AddSensorData(id, data);
  }

  void operator()(const io::OdometryReading& reading) {
    if (!use_odometry_) return;
    if (!Later(reading.time, &last_odometry_)) {
      ++run_->other_readings_left_out;
      return;
    }
    ++run_->odometry_readings;
    builder_->AddSensorData(
        kOdometryId, cartographer::sensor::OdometryData{
                         ToHostTime(reading.time), ToHostPose(reading.pose)});
  }

  void operator()(const io::ImuReading& reading) {
    if (!use_imu_) return;
    if (!Later(reading.time, &last_imu_)) {
      ++run_->other_readings_left_out;
      return;
    }
    ++run_->imu_readings;
    builder_->AddSensorData(
        kImuId, cartographer::sensor::ImuData{ToHostTime(reading.time),
                                              reading.linear_acceleration,
                                              reading.angular_velocity});
  }

 private:
  // By the host's clock, which has coarser ticks than the source.
  static bool Later(const io::TimeNs time, cartographer::common::Time* last) {
    const cartographer::common::Time host_time = ToHostTime(time);
    if (host_time <= *last) return false;
    *last = host_time;
    return true;
  }

  const SensorSettings settings_;
  const bool use_odometry_;
  const bool use_imu_;
  TrajectoryBuilderInterface* const builder_;
  SlamRun* const run_;
  io::TimeNs first_scan_ = 0;
  // By sensor.
  std::map<std::string, cartographer::common::Time> last_scans_;
  cartographer::common::Time last_odometry_ = cartographer::common::Time::min();
  cartographer::common::Time last_imu_ = cartographer::common::Time::min();
};

std::vector<NodePoses> CollectNodePoses(const PoseGraphInterface& pose_graph,
                                        const int trajectory_id) {
  std::vector<NodePoses> result;
  const auto nodes = pose_graph.GetTrajectoryNodes();
  for (const auto& entry : nodes.trajectory(trajectory_id)) {
    if (entry.data.constant_data == nullptr) continue;
    NodePoses poses;
    poses.time = FromHostTime(entry.data.time());
    poses.local_pose = FromHostPose(entry.data.constant_data->local_pose);
    poses.global_pose = FromHostPose(entry.data.global_pose);
    result.push_back(poses);
  }
  std::sort(
      result.begin(), result.end(),
      [](const NodePoses& a, const NodePoses& b) { return a.time < b.time; });
  return result;
}

// Loads the map to start from and makes the run begin in it.
absl::Status StartFrom(const StartingState& state, SlamRun* const run,
                       TrajectoryBuilderOptions* const options) {
  const auto ids = LoadStartingState(state, run->map_builder.get());
  if (!ids.ok()) return ids.status();
  const PoseGraphInterface& pose_graph = *run->map_builder->pose_graph();
  const auto nodes = pose_graph.GetTrajectoryNodePoses();
  run->loaded_nodes = static_cast<int64_t>(nodes.size());
  run->loaded_submaps =
      static_cast<int64_t>(pose_graph.GetAllSubmapPoses().size());
  if (!state.initial_pose.has_value()) return absl::OkStatus();
  return SetInitialPose(*state.initial_pose, (*nodes.begin()).id.trajectory_id,
                        pose_graph, options);
}

void CountResults(const PoseGraphInterface& pose_graph, SlamRun* const run) {
  run->nodes = pose_graph.GetTrajectoryNodes().size();
  run->submaps = pose_graph.GetAllSubmapPoses().size();
  auto constraints = pose_graph.constraints();
  RemoveWithdrawnLoops(&constraints);
  for (const auto& constraint : constraints) {
    if (constraint.tag == PoseGraphInterface::Constraint::INTER_SUBMAP) {
      ++run->inter_constraints;
      if (constraint.submap_id.trajectory_id !=
          constraint.node_id.trajectory_id) {
        ++run->constraints_to_loaded;
      }
    } else {
      ++run->intra_constraints;
    }
  }
}

std::map<std::string, double> Difference(
    std::map<std::string, double> after,
    const std::map<std::string, double>& before) {
  for (const auto& entry : before) after[entry.first] -= entry.second;
  return after;
}

}  // namespace

absl::StatusOr<SlamRun> RunSlam(const SlamConfiguration& configuration,
                                io::SensorSource* const source,
                                const SlamRunOptions& options) {
  const io::SensorSourceInfo& info = source->info();
  SlamRun run;
  if (info.num_scans == 0) {
    return absl::InvalidArgumentError("the recording has no laser scans");
  }
  const bool use_imu =
      configuration.trajectory_builder_options.trajectory_builder_2d_options()
          .use_imu_data();
  if (use_imu && info.num_imu == 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        "configuration ", configuration.name,
        ": TRAJECTORY_BUILDER_2D.use_imu_data is true but the recording has "
        "no IMU readings; set it to false"));
  }
  const bool use_odometry =
      configuration.sensors.use_odometry && info.num_odometry > 0;

  const auto context = std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope(context);
  MetricsCollector* const metrics = MetricsCollector::Global();
  const auto metrics_before = metrics->Values();
  const double searched_before = CountPairs(*metrics, "searched");
  const double found_before = CountPairs(*metrics, "found");
  const LoopCpu loop_cpu_before = MeasureLoopCpu(*metrics);
  loop_closure::DecisionRecorder* const recorder =
      context->Get<loop_closure::DecisionRecorder>();
  recorder->Start(kMaxDecisions);
  front_end::MatchRecorder* const match_recorder =
      context->Get<front_end::MatchRecorder>();
  match_recorder->Start(kMaxMatches);
  const auto wall_start = std::chrono::steady_clock::now();
  const double cpu_start = ProcessCpuSeconds();
  const double thread_cpu_start = ThreadCpuSeconds();

  auto map_builder_options = configuration.map_builder_options;
  if (options.num_background_threads > 0) {
    map_builder_options.set_num_background_threads(
        options.num_background_threads);
  }
  run.map_builder =
      cartographer::mapping::CreateMapBuilder(map_builder_options);
  TrajectoryBuilderOptions trajectory_options =
      configuration.trajectory_builder_options;
  if (!options.state.filename.empty()) {
    const absl::Status started =
        StartFrom(options.state, &run, &trajectory_options);
    if (!started.ok()) return started;
  }
  std::set<SensorId> sensor_ids;
  for (const std::string& laser : info.lasers) {
    sensor_ids.insert({SensorId::SensorType::RANGE, laser});
  }
  if (info.lasers.empty()) {
    sensor_ids.insert({SensorId::SensorType::RANGE, kScanId});
  }
  if (use_odometry) sensor_ids.insert(OdometrySensor());
  if (use_imu) sensor_ids.insert(ImuSensor());
  // Called from within AddSensorData, that is in this thread.
  auto* const local_scan_poses = &run.local_scan_poses;
  // Outlives the run in the callbacks.
  const auto online = std::make_shared<OnlinePoses>();
  run.trajectory_id = run.map_builder->AddTrajectoryBuilder(
      sensor_ids, trajectory_options,
      [local_scan_poses, online](
          int /*trajectory_id*/, const cartographer::common::Time time,
          const cartographer::transform::Rigid3d& local_pose,
          const cartographer::sensor::RangeData& /*range_data_in_local*/,
          std::unique_ptr<const TrajectoryBuilderInterface::InsertionResult>
              inserted) {
        local_scan_poses->push_back(
            {FromHostTime(time), FromHostPose(local_pose)});
        if (inserted != nullptr) {
          online->AddNode(inserted->node_id.node_index, FromHostTime(time));
        }
      });
  PoseGraphInterface* const pose_graph = run.map_builder->pose_graph();
  const int trajectory_id = run.trajectory_id;
  online->Start(
      FromHostPose(pose_graph->GetLocalToGlobalTransform(trajectory_id)));
  pose_graph->SetGlobalSlamOptimizationCallback(
      [online, pose_graph, trajectory_id](
          const std::map<int, cartographer::mapping::SubmapId>& /*submaps*/,
          const std::map<int, cartographer::mapping::NodeId>& nodes) {
        const auto newest = nodes.find(trajectory_id);
        if (newest == nodes.end()) return;
        online->AddOptimization(
            newest->second.node_index,
            FromHostPose(pose_graph->GetLocalToGlobalTransform(trajectory_id)));
      });
  Feeder feeder(configuration.sensors, sensor_ids,
                run.map_builder->GetTrajectoryBuilder(run.trajectory_id), &run);

  SlamProgress progress;
  progress.total_scans = info.num_scans;
  io::SensorEvent event;
  while (true) {
    const absl::StatusOr<bool> more = source->Next(&event);
    if (!more.ok()) {
      // The host does not stand being destroyed while it waits for data.
      run.map_builder->FinishTrajectory(run.trajectory_id);
      return more.status();
    }
    if (!*more) break;
    absl::visit(feeder, event);
    if (!absl::holds_alternative<io::LaserScan>(event)) continue;
    if (options.after_scan) {
      options.after_scan(run.scans + run.scans_left_out, info.num_scans,
                         run.map_builder.get());
    }
    WaitForBackEnd(*metrics, options.max_queue_length, kPatience);
    if (options.on_progress) {
      progress.scans = run.scans + run.scans_left_out;
      progress.queue_length = static_cast<int64_t>(metrics->Sum(kQueueMetric));
      options.on_progress(progress);
    }
  }
  run.map_builder->FinishTrajectory(run.trajectory_id);
  if (run.scans == 0) {
    return absl::InvalidArgumentError(
        "no scan of the recording has a range within the limits");
  }
  progress.stage = SlamProgress::Stage::kOptimizing;
  if (options.on_progress) options.on_progress(progress);
  run.front_end_cpu_seconds = ThreadCpuSeconds() - thread_cpu_start;
  const auto optimization_start = std::chrono::steady_clock::now();
  pose_graph->RunFinalOptimization();
  run.final_optimization_wall_seconds = SecondsSince(optimization_start);

  run.switched_loops =
      context->Get<optimization::SwitchedLoopRecorder>()->Get();

  run.matches = match_recorder->All();
  match_recorder->Stop();
  if (match_recorder->num_dropped() > 0) {
    run.warnings.push_back(absl::StrCat(match_recorder->num_dropped(),
                                        " records of scans dropped"));
  }
  run.decisions = recorder->All();
  recorder->Stop();
  if (recorder->num_dropped() > 0) {
    run.warnings.push_back(
        absl::StrCat(recorder->num_dropped(), " decision records dropped"));
  }
  CountResults(*pose_graph, &run);
  run.online_scan_poses = online->At(run.local_scan_poses);
  run.global_scan_poses = GlobalScanPoses(
      run.local_scan_poses, CollectNodePoses(*pose_graph, run.trajectory_id));
  if (run.global_scan_poses.empty()) {
    run.global_scan_poses = run.online_scan_poses;
  }

  run.wall_seconds = SecondsSince(wall_start);
  run.cpu_seconds = ProcessCpuSeconds() - cpu_start;
  run.peak_memory_bytes = PeakMemoryBytes();
  run.metrics = Difference(metrics->Values(), metrics_before);
  run.loop_searches =
      static_cast<int64_t>(CountPairs(*metrics, "searched") - searched_before);
  run.loops_found =
      static_cast<int64_t>(CountPairs(*metrics, "found") - found_before);
  run.loop_search_cpu_is_measured = metrics->Has(kSearchCpuMetric);
  run.loop_cpu = MeasureLoopCpu(*metrics) - loop_cpu_before;
  run.loop_search_cpu_seconds =
      run.loop_search_cpu_is_measured
          ? run.loop_cpu.total()
          : run.cpu_seconds - (ThreadCpuSeconds() - thread_cpu_start);
  if (run.scans_left_out > 0) {
    run.warnings.push_back(absl::StrCat(
        run.scans_left_out,
        " scans left out: without a valid range or not later than the one "
        "before"));
  }
  if (run.other_readings_left_out > 0) {
    run.warnings.push_back(absl::StrCat(
        run.other_readings_left_out,
        " odometry and IMU readings left out: not later than the one before"));
  }
  return run;
}

absl::Status WritePbstream(MapBuilderInterface* const map_builder,
                           const std::string& filename) {
  AtomicFile file(filename);
  if (!file.status().ok()) return file.status();
  if (!map_builder->SerializeStateToFile(true, file.temporary_path())) {
    return absl::InternalError(absl::StrCat("cannot write ", filename));
  }
  const auto constraints = map_builder->pose_graph()->constraints();
  if (FindWithdrawnLoops(constraints,
                         DescribeConstraint<PoseGraphInterface::Constraint>)
          .empty()) {
    return file.Commit();
  }
  // Programs without our optimization problem would use withdrawn loops. The
  // reader skips them.
  const auto state = io::ReadPbstream(file.temporary_path());
  if (!state.ok()) return state.status();
  return io::WritePbstream(*state, filename);
}

}  // namespace evaluation
}  // namespace cartographer_ext
