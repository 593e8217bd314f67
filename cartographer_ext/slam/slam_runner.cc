// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/slam_runner.h"

#include <errno.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/types/optional.h"
#include "absl/types/variant.h"
#include "cartographer/mapping/map_builder.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/common/thread_time.h"
#include "cartographer_ext/common/withdrawn_loops.h"
#include "cartographer_ext/front_end/match_recorder.h"
#include "cartographer_ext/io/pbstream/pose_graph_edit.h"
#include "cartographer_ext/loop_closure/decision_recorder.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/optimization/dropin/taken_back_loops.h"
#include "cartographer_ext/slam/back_end_metrics.h"
#include "cartographer_ext/slam/latency_meter.h"
#include "cartographer_ext/slam/metrics_collector.h"
#include "cartographer_ext/slam/online_poses.h"
#include "cartographer_ext/slam/resource_usage.h"
#include "cartographer_ext/slam/scan_trajectory.h"
#include "cartographer_ext/slam/sensor_feeder.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using cartographer::mapping::MapBuilderInterface;
using cartographer::mapping::PoseGraphInterface;
using cartographer::mapping::TrajectoryBuilderInterface;
using cartographer::mapping::proto::TrajectoryBuilderOptions;

// Decision records kept, about 400 bytes each.
constexpr size_t kMaxDecisions = 2000000;
// Records of matched scans kept, about 300 bytes each.
constexpr size_t kMaxMatches = 2000000;
// Longest wait for a queue that does not move.
constexpr std::chrono::seconds kPatience(30);

// Seconds of a monotonic clock.
double Now() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

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

// One run from a recording to an optimised map.
class Runner {
 public:
  Runner(const SlamConfiguration& configuration, io::SensorSource* const source,
         const SlamRunOptions& options)
      : configuration_(configuration),
        source_(source),
        info_(source->info()),
        options_(options),
        use_odometry_(configuration.sensors.use_odometry &&
                      info_.num_odometry > 0),
        use_imu_(configuration.trajectory_builder_options
                     .trajectory_builder_2d_options()
                     .use_imu_data()),
        sensors_(SensorFeeder::Sensors(info_.lasers, use_odometry_, use_imu_)) {
  }

  absl::StatusOr<SlamRun> Run() {
    const absl::Status suitable = CheckRecording();
    if (!suitable.ok()) return suitable;
    run_.input_warnings = configuration_.warnings;
    run_.input_warnings.insert(run_.input_warnings.end(),
                               info_.warnings.begin(), info_.warnings.end());
    StartMeasuring();
    const absl::Status started = StartTrajectory();
    if (!started.ok()) return started;
    const absl::Status fed = Feed();
    // Also after an error, because the host must not be destroyed while it
    // waits for data.
    run_.map_builder->FinishTrajectory(run_.trajectory_id);
    if (!fed.ok()) return fed;
    if (run_.scans == 0) {
      return absl::InvalidArgumentError(
          "no scan of the recording has a range within the limits");
    }
    if (run_.local_scan_poses.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "local SLAM used none of the ", run_.scans,
          " scans, so there is no map: no range is within "
          "TRAJECTORY_BUILDER_2D.min_range, max_range and min_z, max_z of ",
          configuration_.name,
          ", or num_accumulated_range_data exceeds the "
          "number of scans"));
    }
    Optimize();
    CollectRecords();
    CollectPoses();
    Measure();
    for (std::string& warning :
         WarningsOf(run_, configuration_.sensors.use_odometry)) {
      run_.warnings.push_back(std::move(warning));
    }
    return std::move(run_);
  }

 private:
  absl::Status CheckRecording() const {
    if (info_.num_scans == 0) {
      return absl::InvalidArgumentError("the recording has no laser scans");
    }
    if (use_imu_ && info_.num_imu == 0) {
      return absl::InvalidArgumentError(absl::StrCat(
          "configuration ", configuration_.name,
          ": TRAJECTORY_BUILDER_2D.use_imu_data is true but the recording has "
          "no IMU readings; set it to false"));
    }
    return absl::OkStatus();
  }

  void StartMeasuring() {
    metrics_before_ = metrics_->Values();
    searched_before_ = CountPairs(*metrics_, "searched");
    found_before_ = CountPairs(*metrics_, "found");
    loop_cpu_before_ = MeasureLoopCpu(*metrics_);
    decision_recorder_->Start(kMaxDecisions);
    match_recorder_->Start(kMaxMatches);
    wall_start_ = Now();
    cpu_start_ = ProcessCpuSeconds();
    thread_cpu_start_ = ThreadCpuSeconds();
  }

  // Creates the map builder, loads the initial state into it, and adds the
  // trajectory.
  absl::Status StartTrajectory() {
    auto map_builder_options = configuration_.map_builder_options;
    if (options_.num_background_threads > 0) {
      map_builder_options.set_num_background_threads(
          options_.num_background_threads);
    }
    run_.map_builder =
        cartographer::mapping::CreateMapBuilder(map_builder_options);
    TrajectoryBuilderOptions trajectory_options =
        configuration_.trajectory_builder_options;
    if (!options_.state.filename.empty()) {
      const absl::Status started =
          StartFrom(options_.state, &run_, &trajectory_options);
      if (!started.ok()) return started;
    }
    // Called from within AddSensorData, on this thread.
    auto* const local_scan_poses = &run_.local_scan_poses;
    const auto online = online_;
    const auto latency = latency_;
    run_.trajectory_id = run_.map_builder->AddTrajectoryBuilder(
        sensors_, trajectory_options,
        [local_scan_poses, online, latency](
            int /*trajectory_id*/, const cartographer::common::Time time,
            const cartographer::transform::Rigid3d& local_pose,
            const cartographer::sensor::RangeData& /*range_data_in_local*/,
            std::unique_ptr<const TrajectoryBuilderInterface::InsertionResult>
                inserted) {
          local_scan_poses->push_back(
              {FromHostTime(time), FromHostPose(local_pose)});
          if (inserted != nullptr) {
            latency->AddNode(Now());
            online->AddNode(inserted->node_id.node_index, FromHostTime(time));
          }
        });
    FollowOptimizations();
    return absl::OkStatus();
  }

  // Records the pose of the robot after each optimization.
  void FollowOptimizations() {
    PoseGraphInterface* const pose_graph = run_.map_builder->pose_graph();
    const int trajectory_id = run_.trajectory_id;
    const auto online = online_;
    online->Start(
        FromHostPose(pose_graph->GetLocalToGlobalTransform(trajectory_id)));
    const bool has_map = run_.loaded_nodes > 0;
    pose_graph->SetGlobalSlamOptimizationCallback(
        [online, pose_graph, trajectory_id, has_map](
            const std::map<int, cartographer::mapping::SubmapId>& /*submaps*/,
            const std::map<int, cartographer::mapping::NodeId>& nodes) {
          const auto newest = nodes.find(trajectory_id);
          if (newest == nodes.end()) return;
          online->AddOptimization(
              newest->second.node_index,
              FromHostPose(
                  pose_graph->GetLocalToGlobalTransform(trajectory_id)));
          if (has_map && !online->is_localized() &&
              IsTiedToOthers(*pose_graph, trajectory_id)) {
            online->SetLocalized(newest->second.node_index);
          }
        });
  }

  absl::Status Feed() {
    SensorFeeder feeder(
        configuration_.sensors, sensors_,
        run_.map_builder->GetTrajectoryBuilder(run_.trajectory_id), &run_);
    progress_.total_scans = info_.num_scans;
    io::SensorEvent event;
    while (true) {
      const absl::StatusOr<bool> more = source_->Next(&event);
      if (!more.ok()) return more.status();
      if (!*more) return absl::OkStatus();
      const bool is_scan = absl::holds_alternative<io::LaserScan>(event);
      WaitUntilDue(event);
      const double start = Now();
      absl::visit(feeder, event);
      latency_->AddReading(Now() - start, is_scan);
      if (!is_scan) continue;
      latency_->SetQueueLength(
          static_cast<size_t>(std::max(0., metrics_->Sum(kQueueMetric))),
          Now());
      if (options_.after_scan) {
        options_.after_scan(run_.scans + run_.skipped_scans, info_.num_scans,
                            run_.map_builder.get());
      }
      WaitForBackEnd(*metrics_, options_.max_queue_length, kPatience);
      if (options_.on_progress) {
        progress_.scans = run_.scans + run_.skipped_scans;
        progress_.queue_length =
            static_cast<int64_t>(metrics_->Sum(kQueueMetric));
        options_.on_progress(progress_);
      }
    }
  }

  void WaitUntilDue(const io::SensorEvent& event) {
    if (options_.realtime_factor <= 0.) return;
    const io::TimeNs time = absl::visit(
        [](const auto& reading) -> io::TimeNs { return reading.time; }, event);
    const double wall = Now();
    if (!first_reading_.has_value()) {
      first_reading_ = time;
      first_fed_ = wall;
    }
    const double due = first_fed_ + io::ToSeconds(time - *first_reading_) /
                                        options_.realtime_factor;
    if (due > wall) {
      std::this_thread::sleep_for(std::chrono::duration<double>(due - wall));
    }
  }

  void Optimize() {
    progress_.stage = SlamProgress::Stage::kOptimizing;
    if (options_.on_progress) options_.on_progress(progress_);
    run_.front_end_cpu_seconds = ThreadCpuSeconds() - thread_cpu_start_;
    const double start = Now();
    run_.map_builder->pose_graph()->RunFinalOptimization();
    run_.final_optimization_wall_seconds = Now() - start;
    run_.switched_loops =
        context_->Get<optimization::SwitchedLoopRecorder>()->Get();
    const std::set<LoopId>& taken_back = run_.switched_loops.taken_back;
    optimization::MarkTakenBack(taken_back, run_.map_builder->pose_graph());
    decision_recorder_->TakeBack(taken_back);
  }

  void CollectRecords() {
    run_.matches = match_recorder_->All();
    match_recorder_->Stop();
    if (match_recorder_->num_dropped() > 0) {
      run_.warnings.push_back(absl::StrCat(match_recorder_->num_dropped(),
                                           " records of scans dropped"));
    }
    std::string gyroscope = WarningOfGyroscope(CountMatches(run_.matches));
    if (!gyroscope.empty()) run_.warnings.push_back(std::move(gyroscope));
    run_.decisions = decision_recorder_->Records();
    decision_recorder_->Stop();
    if (decision_recorder_->num_dropped() > 0) {
      run_.warnings.push_back(absl::StrCat(decision_recorder_->num_dropped(),
                                           " decision records dropped"));
    }
  }

  void CollectPoses() {
    const PoseGraphInterface& pose_graph = *run_.map_builder->pose_graph();
    CountResults(pose_graph, &run_);
    run_.drift =
        context_->Get<uncertainty::DriftModel>()->Of(run_.trajectory_id);
    run_.online_scan_poses = online_->At(run_.local_scan_poses);
    run_.localized_at = online_->LocalizedAt(run_.local_scan_poses);
    run_.global_scan_poses =
        GlobalScanPoses(run_.local_scan_poses,
                        CollectNodePoses(pose_graph, run_.trajectory_id));
    if (run_.global_scan_poses.empty()) {
      run_.global_scan_poses = run_.online_scan_poses;
    }
  }

  void Measure() {
    run_.wall_seconds = Now() - wall_start_;
    run_.latency = latency_->Summary();
    run_.cpu_seconds = ProcessCpuSeconds() - cpu_start_;
    run_.peak_memory_bytes = PeakMemoryBytes();
    run_.metrics = Difference(metrics_->Values(), metrics_before_);
    run_.loop_searches = static_cast<int64_t>(
        CountPairs(*metrics_, "searched") - searched_before_);
    run_.loops_found =
        static_cast<int64_t>(CountPairs(*metrics_, "found") - found_before_);
    run_.loop_search_cpu_is_measured = metrics_->Has(kSearchCpuMetric);
    run_.loop_cpu = MeasureLoopCpu(*metrics_) - loop_cpu_before_;
    run_.loop_search_cpu_seconds =
        run_.loop_search_cpu_is_measured
            ? run_.loop_cpu.total()
            : run_.cpu_seconds - (ThreadCpuSeconds() - thread_cpu_start_);
  }

  const SlamConfiguration& configuration_;
  io::SensorSource* const source_;
  const io::SensorSourceInfo& info_;
  const SlamRunOptions& options_;
  const bool use_odometry_;
  const bool use_imu_;
  const std::set<SensorFeeder::TrajectoryBuilder::SensorId> sensors_;

  const std::shared_ptr<PoseGraphContext> context_ =
      std::make_shared<PoseGraphContext>();
  const ScopedPoseGraphContext scope_{context_};
  loop_closure::DecisionRecorder* const decision_recorder_ =
      context_->Get<loop_closure::DecisionRecorder>();
  front_end::MatchRecorder* const match_recorder_ =
      context_->Get<front_end::MatchRecorder>();
  // Shared with the callbacks, which may outlive the run.
  const std::shared_ptr<OnlinePoses> online_ = std::make_shared<OnlinePoses>();

  const std::shared_ptr<LatencyMeter> latency_ =
      std::make_shared<LatencyMeter>();
  absl::optional<io::TimeNs> first_reading_;
  double first_fed_ = 0.;

  MetricsCollector* const metrics_ = MetricsCollector::Global();
  std::map<std::string, double> metrics_before_;
  double searched_before_ = 0.;
  double found_before_ = 0.;
  LoopCpu loop_cpu_before_;
  double wall_start_ = 0.;
  double cpu_start_ = 0.;
  double thread_cpu_start_ = 0.;

  SlamProgress progress_;
  SlamRun run_;
};

}  // namespace

absl::StatusOr<SlamRun> RunSlam(const SlamConfiguration& configuration,
                                io::SensorSource* const source,
                                const SlamRunOptions& options) {
  SlamConfiguration used = configuration;
  auto* const local_slam =
      used.trajectory_builder_options.mutable_trajectory_builder_2d_options();
  if (local_slam->use_imu_data()) {
    used.sensors.use_recorded_imu = false;  // the recording is as configured
  } else if (used.sensors.use_recorded_imu && source->info().num_imu > 0) {
    local_slam->set_use_imu_data(true);
  }
  return Runner(used, source, options).Run();
}

absl::Status WritePbstream(MapBuilderInterface* const map_builder,
                           const std::string& filename) {
  AtomicFile file(filename);
  if (!file.status().ok()) return file.status();
  errno = 0;
  if (!map_builder->SerializeStateToFile(true, file.temporary_path())) {
    // The host does not report the reason, such as a full disk.
    return absl::ErrnoToStatus(errno == 0 ? EIO : errno,
                               absl::StrCat("cannot write ", filename));
  }
  const auto constraints = map_builder->pose_graph()->constraints();
  if (FindWithdrawnLoops(constraints,
                         DescribeConstraint<PoseGraphInterface::Constraint>)
          .empty()) {
    return file.Commit();
  }
  // Programs without our optimization problem would use withdrawn loops.
  return io::CopyWithEditedPoseGraph(file.temporary_path(), filename,
                                     io::RemoveWithdrawnLoops);
}

}  // namespace evaluation
}  // namespace cartographer_ext
