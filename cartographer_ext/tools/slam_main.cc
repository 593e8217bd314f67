// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: experiments report
// SOURCES: slam_outputs.cc
//
// cartographer_ext_slam: makes a map from a recording and measures it.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/experiments/wrong_loops.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/switched_constraints.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"
#include "cartographer_ext/report/map_report.h"
#include "cartographer_ext/slam/open_recording.h"
#include "cartographer_ext/slam/resource_usage.h"
#include "cartographer_ext/slam/run_summary.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "cartographer_ext/tools/command_line.h"
#include "cartographer_ext/tools/slam_outputs.h"
#include "cartographer_ext/tools/slam_progress.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(input_filename, "",
              "Recording: CARMEN log (.clf .log, also .gz .xz .bz2), ROS 1 bag "
              "(.bag), ROS 2 recording (.mcap, .db3 or the folder of rosbag2) "
              "or world file (.world).");
DEFINE_string(output_filestem, "",
              "Output: <stem>.pbstream, .pgm and .yaml, .png and .html, unless "
              "another flag names the file. Default if the input is given "
              "without -input_filename: its name, in the working folder.");
DEFINE_string(configuration_directory, "",
              "Folders that are searched for Lua files in this order, comma "
              "separated. Empty: the files installed with this command.");
DEFINE_string(configuration_basename, "default.lua",
              "Lua file that returns map_builder and trajectory_builder.");
DEFINE_string(load_state_filename, "",
              "Map (.pbstream) to start from: to localise in it, or to "
              "continue mapping.");
DEFINE_bool(load_frozen_state, true, "Freeze that map.");
DEFINE_string(initial_pose, "",
              "Pose of the robot in that map at the first scan, as X,Y,DEGREES "
              "(metres). Without it the whole map is searched.");
DEFINE_double(realtime_factor, 0.,
              "Replay the recording at this multiple of real time, to measure "
              "latencies as on a robot; 0: as fast as possible.");
DEFINE_int32(num_background_threads, 0,
             "Threads of the back end; 0: as in the configuration. The result "
             "does not depend on it.");
DEFINE_string(scan_topic, "", "Bags: topic of the laser scans.");
DEFINE_string(odometry_topic, "", "Bags: topic of the odometry.");
DEFINE_string(imu_topic, "", "Bags: topic of the IMU.");
DEFINE_string(odometry_source, "",
              "CARMEN logs: take odometry from the ODOM lines (odom), from the "
              "scan lines (scan), from both, or from ODOM lines if there are "
              "any (auto). Empty: as in the configuration.");
DEFINE_double(min_range, 0.,
              "Drop readings closer than this (metres) before local SLAM; 0: "
              "as in the configuration.");
DEFINE_double(max_range, 0.,
              "Drop readings farther than this (metres) before local SLAM; 0: "
              "as in the configuration.");
DEFINE_uint64(seed, 0, "Worlds: seed of noise and faults.");
DEFINE_int32(wrong_loops, 0,
             "Test of the back end: inject this many wrong loops, spread "
             "evenly over the run.");
DEFINE_uint64(wrong_loops_seed, 1, "Seed of the wrong loops.");
DEFINE_string(
    json, "",
    "Output: summary and resource use as JSON; - is standard output.");

DECLARE_string(pbstream_filename);
DECLARE_string(report_filename);

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Builds a 2D map from a recording: local SLAM, loop closure, optimisation.

  cartographer_ext_slam run.bag
      writes run.pbstream, run.pgm and run.yaml (the map for navigation), run.png
      and run.html (the report) into the working folder
  cartographer_ext_slam -input_filename=run.clf -pbstream_filename=run.pbstream \
      -map_filestem=run -picture_filename=run.png -trajectory_filename=run.tum

The configuration is Cartographer's Lua (-configuration_directory,
-configuration_basename): default.lua by default; stock.lua has Cartographer's
own values and none of our blocks. cartographer_ext_evaluate compares the result
with ground truth.

Localise in a finished map (the pose of every scan as published online; evaluate
it with cartographer_ext_evaluate_localization):
  cartographer_ext_slam -input_filename=later.clf -load_state_filename=run.pbstream \
      -configuration_basename=localization.lua \
      -online_trajectory_filename=later.tum [-initial_pose=12.5,3,90])";

absl::StatusOr<evaluation::StartingState> ReadStartingState() {
  evaluation::StartingState state;
  state.filename = FLAGS_load_state_filename;
  state.frozen = FLAGS_load_frozen_state;
  if (FLAGS_initial_pose.empty()) return state;
  const auto pose = evaluation::ParsePose(FLAGS_initial_pose);
  if (!pose.ok()) {
    return tools::WrongUsage(absl::InvalidArgumentError(
        absl::StrCat("-initial_pose ", pose.status().message())));
  }
  state.initial_pose = *pose;
  return state;
}

absl::Status ApplyFlags(evaluation::SensorSettings* const sensors) {
  if (!FLAGS_odometry_source.empty()) {
    sensors->odometry_source = FLAGS_odometry_source;
  }
  if (FLAGS_min_range > 0.) sensors->min_range = FLAGS_min_range;
  if (FLAGS_max_range > 0.) sensors->max_range = FLAGS_max_range;
  if (sensors->max_range <= sensors->min_range) {
    const absl::Status error = absl::InvalidArgumentError(absl::StrFormat(
        "-min_range and -max_range: no range is between the limits, %g m and "
        "%g m",
        sensors->min_range, sensors->max_range));
    return FLAGS_min_range > 0. || FLAGS_max_range > 0.
               ? tools::WrongUsage(error)
               : error;
  }
  return absl::OkStatus();
}

// A configuration for localisation keeps the newest submaps only, and none at
// the end.
absl::Status CheckKeepsMap(const evaluation::SlamConfiguration& configuration) {
  if (!FLAGS_load_state_filename.empty() || !tools::WritesMap() ||
      !configuration.trajectory_builder_options
           .has_pure_localization_trimmer()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(
      FLAGS_configuration_basename,
      " is for localisation (TRAJECTORY_BUILDER.pure_localization_trimmer) and "
      "leaves no map: name the map to localise in with -load_state_filename, "
      "or map with default.lua"));
}

void PrintRecording(const io::SensorSourceInfo& info, std::ostream& out) {
  out << absl::StrFormat(
      "Recording  %s, %d scans, %d odometry and %d IMU readings, %.1f s\n",
      info.format, info.num_scans, info.num_odometry, info.num_imu,
      io::ToSeconds(info.end - info.begin));
}

// Of the injected wrong loops.
int CountSwitchedOff(const evaluation::SlamRun& run,
                     const std::vector<evaluation::GraphConstraint>& injected) {
  evaluation::MapGraph graph;
  graph.constraints = injected;
  return evaluation::MarkSwitchedOff(run.switched_loops.off, &graph).size();
}

// The heap keeps what is freed until it is told not to.
void GiveBackMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// What takes memory and is written.
void Free(evaluation::SlamRun* const run) {
  run->map_builder.reset();
  run->decisions = {};
  run->matches = {};
  GiveBackMemory();
}

// Judges and paints the map just written: the report, and the evaluation for
// JSON.
absl::Status WriteReport(const evaluation::MapGraph& graph,
                         const std::string& command_line,
                         nlohmann::ordered_json* const json,
                         std::ostream& out) {
  auto step = tools::ShowStep("judging the map");
  auto map = report::JudgeMap(FLAGS_pbstream_filename);
  if (!map.ok()) return map.status();
  const auto page = report::MakeMapPage(
      **map, tools::BaseName(FLAGS_input_filename), command_line);
  if (!page.ok()) return page.status();
  const std::string text = evaluation::ToText((*map)->evaluation);
  (*json)["evaluation"] = evaluation::ToJson((*map)->evaluation);
  const evaluation::MapGraph stored = std::move((*map)->graph);
  evaluation::MapGrids grids =
      evaluation::TakeGrids(std::move((*map)->contents));
  map->reset();
  GiveBackMemory();
  const absl::Status painted =
      tools::WritePaintedMap(graph, [&](const double resolution) {
        auto painted = evaluation::PaintGrids(stored, grids, resolution);
        grids.clear();
        GiveBackMemory();
        return painted;
      });
  step.reset();
  if (!painted.ok()) return painted;
  out << text;
  return WriteFileAtomically(FLAGS_report_filename, *page);
}

// Of the whole command, but for writing the JSON.
void ReportMemory(nlohmann::ordered_json* const json, std::ostream& out) {
  const int64_t peak = evaluation::PeakMemoryBytes();
  (*json)["peak_memory_bytes"] = peak;
  out << absl::StrFormat("Memory     at most %.0f MB\n", 1e-6 * peak);
}

nlohmann::ordered_json RunToJson(const evaluation::SlamRun& run) {
  nlohmann::ordered_json json;
  json["input"] = FLAGS_input_filename;
  json["configuration"] = FLAGS_configuration_basename;
  json.update(evaluation::ToJson(run));
  if (!FLAGS_load_state_filename.empty()) {
    json["loaded"] = {{"filename", FLAGS_load_state_filename},
                      {"frozen", FLAGS_load_frozen_state},
                      {"nodes", run.loaded_nodes},
                      {"submaps", run.loaded_submaps},
                      {"constraints", run.constraints_to_loaded}};
  }
  return json;
}

io::SensorSourceOptions SourceOptions(
    const evaluation::SensorSettings& settings) {
  io::SensorSourceOptions options = evaluation::ToSourceOptions(settings);
  options.scan_topic = FLAGS_scan_topic;
  options.odometry_topic = FLAGS_odometry_topic;
  options.imu_topic = FLAGS_imu_topic;
  return options;
}

tools::SlamWork WorkOf(const io::SensorSourceInfo& info,
                       const evaluation::SlamConfiguration& configuration) {
  tools::SlamWork work;
  work.total_scans = info.num_scans;
  work.judges_map = !FLAGS_report_filename.empty();
  const int64_t readings =
      (configuration.sensors.use_odometry ? info.num_odometry : 0) +
      (evaluation::UsesImu(configuration) ? info.num_imu : 0);
  work.readings_a_scan =
      static_cast<double>(readings) / std::max<double>(1., info.num_scans);
  return work;
}

// Names the recording, unless it is the map to start from that is wrong.
absl::Status OfRecording(const absl::Status& status) {
  if (!FLAGS_load_state_filename.empty() &&
      absl::StrContains(status.message(), FLAGS_load_state_filename)) {
    return status;
  }
  return absl::Status(status.code(), absl::StrCat(FLAGS_input_filename, ": ",
                                                  status.message()));
}

// Flags that are set and have no effect on a recording of this format.
std::vector<std::string> NotesOnFlags(const std::string& format) {
  const bool is_log = format == "carmen", is_world = format == "world";
  struct Use {
    const char* flag;
    bool is_set;
    bool has_effect;
    const char* recordings;
  };
  std::vector<std::string> notes;
  for (const Use& use : {Use{"scan_topic", !FLAGS_scan_topic.empty(),
                             !is_log && !is_world, "ROS recordings"},
                         Use{"odometry_topic", !FLAGS_odometry_topic.empty(),
                             !is_log && !is_world, "ROS recordings"},
                         Use{"imu_topic", !FLAGS_imu_topic.empty(),
                             !is_log && !is_world, "ROS recordings"},
                         Use{"odometry_source", !FLAGS_odometry_source.empty(),
                             is_log, "CARMEN logs"},
                         Use{"seed", FLAGS_seed != 0, is_world, "worlds"}}) {
    if (!use.is_set || use.has_effect) continue;
    notes.push_back(absl::StrCat("-", use.flag, " has no effect: it is for ",
                                 use.recordings));
  }
  return notes;
}

absl::Status Run(const std::string& command_line) {
  auto state = ReadStartingState();
  if (!state.ok()) return state.status();
  const absl::Status writable = tools::CheckSlamOutputs();
  if (!writable.ok()) return writable;
  const std::vector<std::string> directories =
      tools::ConfigurationDirectories(FLAGS_configuration_directory);
  auto configuration = evaluation::LoadSlamConfiguration(
      directories, FLAGS_configuration_basename);
  if (!configuration.ok()) return configuration.status();
  tools::PrintNotes(configuration->warnings);
  absl::Status applied = ApplyFlags(&configuration->sensors);
  if (applied.ok()) applied = CheckKeepsMap(*configuration);
  if (!applied.ok()) return applied;
  auto source = evaluation::OpenRecording(
      FLAGS_input_filename, SourceOptions(configuration->sensors), FLAGS_seed);
  if (!source.ok()) return source.status();
  // If the JSON goes to standard output, nothing else may.
  std::ostream& out = FLAGS_json == "-" ? std::cerr : std::cout;
  PrintRecording((*source)->info(), out);
  tools::PrintNotes(NotesOnFlags((*source)->info().format));
  tools::PrintNotes((*source)->info().warnings);

  auto progress = std::make_unique<tools::SlamProgressLine>(
      WorkOf((*source)->info(), *configuration));
  evaluation::SlamRunOptions run_options;
  run_options.state = *std::move(state);
  run_options.num_background_threads = FLAGS_num_background_threads;
  run_options.realtime_factor = FLAGS_realtime_factor;
  evaluation::WrongLoopOptions wrong_loops;
  wrong_loops.count = FLAGS_wrong_loops;
  wrong_loops.seed = FLAGS_wrong_loops_seed;
  evaluation::WrongLoopInjector injector(evaluation::WithLoopWeights(
      configuration->map_builder_options, wrong_loops));
  if (FLAGS_wrong_loops > 0) run_options.after_scan = injector.Callback();
  run_options.on_progress = [&](const evaluation::SlamProgress& now) {
    progress->Update(now.scans, now.queue_length,
                     now.stage == evaluation::SlamProgress::Stage::kOptimizing);
  };
  auto run = evaluation::RunSlam(*configuration, source->get(), run_options);
  progress.reset();
  if (!run.ok()) {
    return OfRecording(run.status());
  }
  tools::PrintNotes(run->warnings);
  AtomicFileSet files;
  auto step = tools::ShowStep("writing the files");
  const evaluation::MapGraph graph = tools::MarkedGraph(*run);
  absl::Status written = tools::WriteSlamResults(*run, graph);
  const bool judges_map = !FLAGS_report_filename.empty();
  if (written.ok() && !judges_map) {
    written = tools::WritePaintedMap(graph, [&run](const double resolution) {
      return evaluation::PaintHostMap(*run->map_builder->pose_graph(),
                                      resolution);
    });
  }
  step.reset();
  if (!written.ok()) return written;
  out << evaluation::ToText(*run);
  nlohmann::ordered_json json = RunToJson(*run);
  if (judges_map) {
    Free(&*run);
    source->reset();
    const absl::Status reported = WriteReport(graph, command_line, &json, out);
    if (!reported.ok()) return reported;
  }
  ReportMemory(&json, out);
  if (FLAGS_wrong_loops > 0) {
    json["wrong_loops"] = {
        {"injected", injector.injected().size()},
        {"switched_off", CountSwitchedOff(*run, injector.injected())}};
  }
  absl::Status status;
  if (!FLAGS_json.empty()) status = tools::WriteJson(json, FLAGS_json);
  if (status.ok()) status = files.Commit();
  if (status.ok()) tools::PrintSlamOutputs(out);
  return status;
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
#ifdef __GLIBC__
  // All threads share one heap, so that memory freed by one is used by another.
  // This saves a fifth of the memory at no measurable cost.
  mallopt(M_ARENA_MAX, 1);
  // What grids and search structures free is given back at once. Otherwise
  // glibc raises this limit to 32 MB, and they leave holes in the heap: a sixth
  // of the memory on ACES.
  mallopt(M_MMAP_THRESHOLD, 512 << 10);
#endif
  const std::string arguments = absl::StrJoin(argv, argv + argc, " ");
  tools::CommandLine command_line(kDescription, "input_filename");
  command_line.TakeOneOf("odometry_source", {"odom", "scan", "both", "auto"});
  command_line.Parse(argc, argv);
  if (FLAGS_output_filestem.empty() && command_line.has_positional_input()) {
    FLAGS_output_filestem = evaluation::RecordingStem(FLAGS_input_filename);
  }
  tools::NameSlamOutputs(FLAGS_output_filestem);
  if (FLAGS_input_filename.empty()) {
    return tools::UsageError("no recording is given");
  }
  if (!(FLAGS_realtime_factor >= 0.) || std::isinf(FLAGS_realtime_factor)) {
    return tools::UsageError("-realtime_factor must be a number >= 0");
  }
  if (FLAGS_num_background_threads < 0 || FLAGS_wrong_loops < 0) {
    return tools::UsageError(
        "-num_background_threads and -wrong_loops must not be negative");
  }
  if (!FLAGS_initial_pose.empty() && FLAGS_load_state_filename.empty()) {
    return tools::UsageError("-initial_pose needs -load_state_filename");
  }
  if (!FLAGS_report_filename.empty() && FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-report_filename needs -pbstream_filename");
  }
  return tools::ExitCode(Run(arguments));
}
