// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: repair_library
//
// cartographer_ext_repair: improves a finished map.
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/repair/kept_frame.h"
#include "cartographer_ext/repair/map_repair.h"
#include "cartographer_ext/repair/repair_output.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "", "Map to repair.");
DEFINE_string(output_filename, "",
              "Output: the repaired map. Written only if it is better than the "
              "input.");
DEFINE_string(report_filename, "", "Output: report as one HTML file.");
DEFINE_string(
    poses_filename, "",
    "Output: CSV with the pose of every node in the old and in the new map. "
    "Default with -keep_frame: MAP.poses.csv beside the repaired map.");
DEFINE_string(only, "loops,local",
              "Steps, comma separated: loops (re-evaluated, searched again), "
              "local (local SLAM re-run from the node clouds).");
DEFINE_bool(
    keep_frame, false,
    "Keep the frame of the map by a robust fit of its nodes, so that unchanged "
    "parts keep their coordinates. Otherwise the first node is fixed.");
DEFINE_bool(
    drop_odometry, false,
    "Leave the odometry readings out of the repaired map, so that they do not "
    "pull on it where Cartographer optimises it again.");
DEFINE_bool(dry_run, false, "Try all steps and report, without writing a map.");
DEFINE_string(drop_loops, "",
              "Loops to remove, comma separated: "
              "submap_trajectory:submap:node_trajectory:node.");
DEFINE_string(add_loops, "",
              "Loops to add, with the same ids, optionally followed by "
              ":x:y:theta (node in the submap, metres and radians; otherwise "
              "the whole submap is searched). Accepted only if the scan and "
              "its neighbours match and the map is better.");
DEFINE_string(configuration_directory, "",
              "Folders with Lua files, comma separated. Empty: the files "
              "installed with this command.");
DEFINE_string(configuration_basename, "default.lua",
              "Lua file for loop closure and local SLAM. Stock is the same "
              "file without our blocks.");
DEFINE_int32(num_background_threads, 2,
             "Number of threads. The result does not depend on it.");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Repairs a finished map without its recording.

  cartographer_ext_repair map.pbstream -output_filename=repaired.pbstream \
      -report_filename=repair.html
  cartographer_ext_repair map.pbstream -dry_run

Loops are re-evaluated, loop closure is re-run, and local SLAM is re-run from the
clouds of the nodes. A step is kept only if it improves the verdict; a sound map
is not changed. Nothing is written unless it is better than the input. The exit
code is 3 if the final map is doubtful or broken.)";

std::string PosesFilename() {
  if (!FLAGS_poses_filename.empty() || !FLAGS_keep_frame ||
      FLAGS_output_filename.empty() || FLAGS_dry_run) {
    return FLAGS_poses_filename;
  }
  return absl::StrCat(absl::StripSuffix(FLAGS_output_filename, ".pbstream"),
                      ".poses.csv");
}

// Wrong usage where the flag does not name loops; the map may also lack them.
absl::Status OfLoops(const std::string& flag, const absl::Status& status) {
  const absl::Status named(status.code(),
                           absl::StrCat(flag, ": ", status.message()));
  return absl::IsInvalidArgument(status) ? tools::WrongUsage(named) : named;
}

absl::StatusOr<repair::RepairOptions> MakeOptions(
    const evaluation::MapGraph& graph) {
  repair::RepairOptions options;
  const std::vector<std::string> directories =
      tools::ConfigurationDirectories(FLAGS_configuration_directory);
  auto configuration = evaluation::LoadRerunConfiguration(
      directories, FLAGS_configuration_basename, "", graph);
  if (!configuration.ok()) return configuration.status();
  options.configuration = *std::move(configuration);
  const auto slam = evaluation::LoadSlamConfiguration(
      directories, FLAGS_configuration_basename);
  if (!slam.ok()) return slam.status();
  options.local_slam =
      slam->trajectory_builder_options.trajectory_builder_2d_options();
  options.loops = options.local = false;
  for (const auto& name : absl::StrSplit(FLAGS_only, absl::ByAnyChar(", "))) {
    options.loops = options.loops || name == "loops";
    options.local = options.local || name == "local";
  }
  const auto dropped = evaluation::FindLoops(graph, FLAGS_drop_loops);
  if (!dropped.ok()) return OfLoops("-drop_loops", dropped.status());
  options.dropped_loops = *dropped;
  const auto added = repair::ParseLoopsByHand(graph, FLAGS_add_loops);
  if (!added.ok()) return OfLoops("-add_loops", added.status());
  options.added_loops = *added;
  options.keep_frame = FLAGS_keep_frame;
  options.drop_odometry = FLAGS_drop_odometry;
  options.num_background_threads = FLAGS_num_background_threads;
  return options;
}

absl::Status WriteOutputs(const repair::MapRepair& repair, const bool written,
                          const std::string& command_line) {
  absl::Status status;
  if (!FLAGS_report_filename.empty()) {
    const auto page = repair::MakeRepairReport(
        repair, tools::BaseName(FLAGS_pbstream_filename), command_line);
    if (!page.ok()) return page.status();
    status = WriteFileAtomically(FLAGS_report_filename, *page);
  }
  if (status.ok() && !PosesFilename().empty()) {
    status = WriteFileAtomically(
        PosesFilename(),
        repair::PoseTable(repair.before.graph, repair.after.graph));
  }
  if (status.ok() && written) {
    status = io::WritePbstream(*repair.after.pbstream, FLAGS_output_filename);
  }
  if (!status.ok() || FLAGS_json.empty()) return status;
  nlohmann::ordered_json json;
  json["pbstream"] = FLAGS_pbstream_filename;
  json["written"] = written;
  json.update(repair::ToJson(repair));
  return tools::WriteJson(json, FLAGS_json);
}

absl::Status Run(const std::string& command_line, bool* const fails) {
  const absl::Status writable = tools::CheckWritable(
      {FLAGS_dry_run ? "" : FLAGS_output_filename, FLAGS_report_filename,
       PosesFilename(), FLAGS_json});
  if (!writable.ok()) return writable;
  auto pbstream = io::ReadPbstream(FLAGS_pbstream_filename);
  if (!pbstream.ok()) return pbstream.status();
  const auto in_file = [](const absl::Status& status) {
    return absl::Status(status.code(), absl::StrCat(FLAGS_pbstream_filename,
                                                    ": ", status.message()));
  };
  auto options = MakeOptions(evaluation::MakeMapGraph(*pbstream));
  if (!options.ok()) return options.status();
  Progress progress("repairing", 0);
  std::string step = "judging the map";
  progress.Update(0, step);
  options->on_step = [&](const std::string& name) {
    step = name;
    progress.Update(0, step);
  };
  options->on_progress = [&](const int64_t done, const int64_t total) {
    progress.Update(done, absl::StrCat("of ", total, " nodes, ", step));
  };
  const auto repair = repair::RepairMap(*std::move(pbstream), *options);
  progress.Finish();
  if (!repair.ok()) return in_file(repair.status());
  const std::string& verdict = repair->after.consistency.word;
  *fails = verdict == "doubtful" || verdict == "broken";
  const bool written = repair->changed() && !FLAGS_dry_run;
  AtomicFileSet files;
  absl::Status status = WriteOutputs(*repair, written, command_line);
  if (status.ok()) status = files.Commit();
  if (!status.ok()) return status;
  if (FLAGS_json != "-") {
    std::cout << repair::ToText(*repair)
              << (written ? absl::StrCat("written: ", FLAGS_output_filename)
                          : "no map was written")
              << "\n";
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  const std::string command_line = absl::StrJoin(argv, argv + argc, " ");
  tools::CommandLine arguments(kDescription, "pbstream_filename");
  arguments.TakeListOf("only", {"loops", "local"});
  arguments.Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-pbstream_filename is missing");
  }
  if (FLAGS_output_filename.empty() && !FLAGS_dry_run) {
    return tools::UsageError("-output_filename is missing (or use -dry_run)");
  }
  if (FLAGS_only.empty()) return tools::UsageError("-only names no step");
  if (FLAGS_num_background_threads < 1) {
    return tools::UsageError("-num_background_threads must be above 0");
  }
  bool fails = false;
  const absl::Status status = Run(command_line, &fails);
  return tools::ExitCode(status, fails);
}
