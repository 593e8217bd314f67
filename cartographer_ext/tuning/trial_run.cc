// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tuning/trial_run.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"
#include "cartographer_ext/map/verdict/motion_disagreement.h"
#include "cartographer_ext/map/verdict/self_consistency.h"
#include "cartographer_ext/metrics/relations_metric.h"
#include "cartographer_ext/metrics/trajectory_metrics.h"
#include "cartographer_ext/rerun/rerun.h"
#include "cartographer_ext/simulation/truth.h"
#include "cartographer_ext/simulation/world_source.h"
#include "cartographer_ext/slam/open_recording.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace tuning {
namespace {

using Metrics = std::map<std::string, double>;

// The first part of a recording.
class FirstPart : public io::SensorSource {
 public:
  FirstPart(std::unique_ptr<io::SensorSource> source, const double share)
      : source_(std::move(source)), info_(source_->info()) {
    end_ =
        info_.begin + static_cast<io::TimeNs>(
                          share * static_cast<double>(info_.end - info_.begin));
  }

  const io::SensorSourceInfo& info() const override { return info_; }

  absl::StatusOr<bool> Next(io::SensorEvent* const event) override {
    auto more = source_->Next(event);
    if (!more.ok() || !*more) return more;
    return io::EventTime(*event) <= end_;
  }

 private:
  const std::unique_ptr<io::SensorSource> source_;
  const io::SensorSourceInfo info_;
  io::TimeNs end_ = 0;
};

struct Truth {
  absl::optional<std::vector<evaluation::Relation>> relations;
  absl::optional<evaluation::Trajectory> reference;
};

Truth TruthOf(const simulation::Simulation& simulation) {
  const auto true_poses = simulation::TrueTrajectory(simulation);
  std::vector<io::StampedPose> poses;
  for (const simulation::TruePose& pose : true_poses) {
    poses.push_back(io::MakeStampedPose(pose.time, pose.pose));
  }
  auto relations = simulation::SequentialRelations(true_poses);
  const auto loops = simulation::LoopRelations(simulation, true_poses);
  relations.insert(relations.end(), loops.begin(), loops.end());
  Truth truth;
  truth.reference = evaluation::Trajectory(std::move(poses));
  truth.relations.emplace();
  for (const simulation::TrueRelation& relation : relations) {
    evaluation::Relation stamped;
    stamped.time1 = relation.first;
    stamped.time2 = relation.second;
    stamped.relative = evaluation::ToIsometry(relation.relative);
    truth.relations->push_back(stamped);
  }
  return truth;
}

absl::StatusOr<Truth> ReadTruth(const TuneInput& input) {
  Truth truth;
  if (!input.relations_filename.empty()) {
    auto relations = io::ReadRelations(input.relations_filename);
    if (!relations.ok()) return relations.status();
    truth.relations = *std::move(relations);
  }
  if (!input.reference_filename.empty()) {
    auto poses = io::ReadTumTrajectory(input.reference_filename);
    if (!poses.ok()) return poses.status();
    truth.reference = evaluation::Trajectory(*std::move(poses));
  }
  return truth;
}

absl::Status AddAccuracy(const Truth& truth,
                         const evaluation::Trajectory& trajectory,
                         const bool poses_are_scans, Metrics* const metrics) {
  if (truth.relations.has_value()) {
    evaluation::RelationsMetricOptions options;
    if (!poses_are_scans) options.stamp_tolerance = 0;
    const auto metric = evaluation::ComputeRelationsMetric(
        trajectory, *truth.relations, options);
    if (!metric.ok()) return metric.status();
    (*metrics)["relations"] = metric->all.translation.mean;
    (*metrics)["relations_median"] = metric->all.translation.median;
    (*metrics)["relations_rotation"] = metric->all.rotation_degrees.mean;
    (*metrics)["broken_fraction"] = metric->all.fraction_above_half_metre;
    if (metric->loop.count > 0) {
      (*metrics)["relations_loop"] = metric->loop.translation.mean;
    }
  }
  if (truth.reference.has_value()) {
    const auto errors = evaluation::ComputeTrajectoryErrors(
        trajectory, *truth.reference, evaluation::TrajectoryMetricsOptions());
    if (!errors.ok()) return errors.status();
    (*metrics)["ate"] = errors->ate.rmse;
    (*metrics)["rpe"] = errors->rpe.rmse;
  }
  return absl::OkStatus();
}

void AddLoops(const Truth& truth, const evaluation::MapGraph& graph,
              Metrics* const metrics) {
  const evaluation::LoopStatisticsOptions options;
  evaluation::LoopStatistics loops;
  if (truth.reference.has_value()) {
    loops = evaluation::ComputeLoopStatistics(graph, *truth.reference, options);
  } else if (truth.relations.has_value()) {
    loops = evaluation::ComputeLoopStatistics(graph, *truth.relations, options);
  } else {
    loops = evaluation::ComputeLoopStatistics(graph);
  }
  (*metrics)["nodes"] = static_cast<double>(graph.nodes.size());
  (*metrics)["submaps"] = static_cast<double>(graph.submaps.size());
  (*metrics)["loops"] = static_cast<double>(loops.accepted);
  if (!loops.recall.has_value()) return;
  (*metrics)["loop_recall"] = *loops.recall;
  // A map without loops has no wrong ones.
  (*metrics)["loop_precision"] = loops.precision.value_or(1.);
}

// Shares of inconsistent scans, and how much thicker walls are where they were
// seen in more than one visit.
void AddSelfConsistency(const evaluation::MapGraph& graph,
                        const io::Pbstream& pbstream, Metrics* const metrics) {
  const evaluation::SelfConsistency result = evaluation::AssessSelfConsistency(
      graph,
      evaluation::ReadMapContents(pbstream, evaluation::MapContentsOptions()),
      evaluation::ReadOdometry(pbstream), evaluation::SelfConsistencyOptions());
  const double doubling = std::max(0., result.sharpness.doubling - 1.);
  (*metrics)["node_contradiction"] = result.contradictions.node_fraction();
  (*metrics)["ray_contradiction"] = result.contradictions.ray_fraction();
  (*metrics)["cycle_contradiction"] = result.cycles.fraction();
  (*metrics)["wall_doubling"] = doubling;
  (*metrics)["self_consistency"] = result.contradictions.node_fraction() +
                                   result.contradictions.ray_fraction() +
                                   result.cycles.fraction() + doubling;
}

// The map of a run, as it would be read from a file.
absl::StatusOr<io::Pbstream> ToPbstream(
    cartographer::mapping::MapBuilderInterface* const map_builder) {
  const char* const folder = getenv("TMPDIR");
  std::string name = absl::StrCat(folder == nullptr ? "/tmp" : folder,
                                  "/cartographer_ext_tune_XXXXXX");
  const int descriptor = mkstemp(&name[0]);
  if (descriptor < 0) {
    return absl::InternalError(absl::StrCat(name, ": ", strerror(errno)));
  }
  close(descriptor);
  const absl::Status status = evaluation::WritePbstream(map_builder, name);
  auto pbstream = status.ok() ? io::ReadPbstream(name)
                              : absl::StatusOr<io::Pbstream>(status);
  unlink(name.c_str());
  return pbstream;
}

absl::StatusOr<Metrics> RunRecording(
    const evaluation::SlamConfiguration& configuration,
    const RunRequest& request) {
  absl::StatusOr<Truth> truth = Truth();
  std::unique_ptr<io::SensorSource> source;
  if (request.input.is_world) {
    simulation::SimulationOptions options;
    options.seed = request.input.seed;
    auto world =
        simulation::OpenWorldWithOptions(request.input.recording, options);
    if (!world.ok()) return world.status();
    truth = TruthOf((*world)->simulation());
    source = *std::move(world);
  } else {
    truth = ReadTruth(request.input);
    if (!truth.ok()) return truth.status();
    auto recording = evaluation::OpenRecording(
        request.input.recording,
        evaluation::ToSourceOptions(configuration.sensors), 0);
    if (!recording.ok()) return recording.status();
    source = *std::move(recording);
  }
  if (request.fidelity < 1.) {
    source = std::make_unique<FirstPart>(std::move(source), request.fidelity);
  }
  evaluation::SlamRunOptions options;
  options.num_background_threads = request.num_threads;
  const auto run = evaluation::RunSlam(configuration, source.get(), options);
  if (!run.ok()) return run.status();
  Metrics metrics;
  metrics["wall_seconds"] = run->wall_seconds;
  metrics["cpu_seconds"] = run->cpu_seconds;
  metrics["loop_search_cpu_seconds"] = run->loop_search_cpu_seconds;
  const absl::Status status = AddAccuracy(
      *truth, evaluation::Trajectory(run->global_scan_poses), true, &metrics);
  if (!status.ok()) return status;
  const auto& pose_graph = *run->map_builder->pose_graph();
  const evaluation::MapGraph graph = evaluation::MakeMapGraph(pose_graph);
  AddLoops(*truth, graph, &metrics);
  if (request.wants_self_consistency) {
    const auto pbstream = ToPbstream(run->map_builder.get());
    if (!pbstream.ok()) return pbstream.status();
    AddSelfConsistency(graph, *pbstream, &metrics);
  }
  return metrics;
}

absl::StatusOr<Metrics> RunPbstream(
    const evaluation::SlamConfiguration& configuration,
    const RunRequest& request) {
  const auto truth = ReadTruth(request.input);
  if (!truth.ok()) return truth.status();
  const auto pbstream = io::ReadPbstream(request.input.recording);
  if (!pbstream.ok()) return pbstream.status();
  evaluation::RerunOptions options;
  options.num_background_threads = request.num_threads;
  const auto rerun = evaluation::RerunPoseGraph(
      *pbstream, configuration.map_builder_options.pose_graph_options(),
      options);
  if (!rerun.ok()) return rerun.status();
  Metrics metrics;
  metrics["wall_seconds"] = rerun->wall_seconds;
  metrics["cpu_seconds"] = rerun->cpu_seconds;
  metrics["loop_search_cpu_seconds"] = rerun->loop_cpu.total();
  const absl::Status status =
      AddAccuracy(*truth, rerun->graph.GlobalTrajectory(), false, &metrics);
  if (!status.ok()) return status;
  AddLoops(*truth, rerun->graph, &metrics);
  if (request.wants_self_consistency) {
    AddSelfConsistency(rerun->graph, *pbstream, &metrics);
  }
  return metrics;
}

}  // namespace

nlohmann::json ToJson(const RunRequest& request) {
  const TuneInput& input = request.input;
  return {{"code", request.code},
          {"name", request.name},
          {"directories", request.directories},
          {"fidelity", request.fidelity},
          {"odometry_source", request.odometry_source},
          {"num_threads", request.num_threads},
          {"wants_self_consistency", request.wants_self_consistency},
          {"input",
           {{"name", input.name},
            {"recording", input.recording},
            {"relations", input.relations_filename},
            {"reference", input.reference_filename},
            {"seed", input.seed},
            {"is_world", input.is_world},
            {"is_pbstream", input.is_pbstream}}}};
}

absl::StatusOr<RunRequest> RequestFromJson(const nlohmann::json& json) {
  RunRequest request;
  // The message comes from this program, but may be truncated.
  if (!json.is_object() || !json.contains("input") || !json.contains("code")) {
    return absl::InvalidArgumentError("not a request for a run");
  }
  request.code = json.value("code", "");
  request.name = json.value("name", "");
  request.directories = json.value("directories", std::vector<std::string>());
  request.fidelity = json.value("fidelity", 1.);
  request.odometry_source = json.value("odometry_source", "");
  request.num_threads = json.value("num_threads", 1);
  request.wants_self_consistency = json.value("wants_self_consistency", false);
  const nlohmann::json& input = json["input"];
  request.input.name = input.value("name", "");
  request.input.recording = input.value("recording", "");
  request.input.relations_filename = input.value("relations", "");
  request.input.reference_filename = input.value("reference", "");
  request.input.seed = input.value("seed", uint64_t{0});
  request.input.is_world = input.value("is_world", false);
  request.input.is_pbstream = input.value("is_pbstream", false);
  return request;
}

absl::StatusOr<Metrics> RunTrial(const RunRequest& request) {
  auto configuration = evaluation::ParseSlamConfiguration(
      request.directories, request.name, request.code);
  if (!configuration.ok()) return configuration.status();
  if (!request.odometry_source.empty()) {
    configuration->sensors.odometry_source = request.odometry_source;
  }
  return request.input.is_pbstream ? RunPbstream(*configuration, request)
                                   : RunRecording(*configuration, request);
}

nlohmann::json AnswerRequest(const nlohmann::json& request) {
  const auto parsed = RequestFromJson(request);
  if (!parsed.ok()) return Failure(std::string(parsed.status().message()));
  const auto metrics = RunTrial(*parsed);
  if (!metrics.ok()) return Failure(std::string(metrics.status().message()));
  return {{"ok", true}, {"metrics", *metrics}};
}

}  // namespace tuning
}  // namespace cartographer_ext
