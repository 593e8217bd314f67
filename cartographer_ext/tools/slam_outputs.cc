// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/slam_outputs.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pose_graph_edit.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/loop_closure/decision_log.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/map_picture.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/map/switched_constraints.h"
#include "cartographer_ext/map/verdict/decision_table.h"
#include "cartographer_ext/slam/decision_files.h"
#include "cartographer_ext/slam/match_files.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"

DECLARE_string(input_filename);
DECLARE_string(load_state_filename);
DECLARE_string(json);

DEFINE_string(pbstream_filename, "",
              "Output: the map as a Cartographer state (.pbstream).");
DEFINE_string(map_filestem, "",
              "Output: occupancy map <stem>.pgm and <stem>.yaml.");
DEFINE_double(resolution, 0.05,
              "Resolution of the occupancy map, metres per cell.");
DEFINE_string(picture_filename, "",
              "Output: PNG of the map with path and loops.");
DEFINE_string(report_filename, "",
              "Output: HTML report of the map; needs -pbstream_filename.");
DEFINE_string(trajectory_filename, "",
              "Output: optimised pose at every scan (TUM: timestamp x y z qx "
              "qy qz qw).");
DEFINE_string(
    local_trajectory_filename, "",
    "Output: pose at every scan by local SLAM, without loop closure (TUM).");
DEFINE_string(online_trajectory_filename, "",
              "Output: pose at every scan as published online (TUM), including "
              "the jumps caused by optimisations.");
DEFINE_string(decisions_filename, "",
              "Output: CSV of every loop candidate, with the reason why it was "
              "accepted or not (docs/side_files.md); without our loop closure, "
              "of the accepted loops.");
DEFINE_string(switched_loops_filename, "",
              "Output: CSV of the loops that the robust back end disabled in "
              "the last optimisation.");
DEFINE_bool(keep_switched_loops, true, "Keep these loops in the pbstream.");

namespace cartographer_ext {
namespace tools {
namespace {

// Whether the map goes to a device or pipe, which has no files beside it and
// cannot be read again.
bool MapIsNoFile() {
  struct stat existing;
  return ::stat(FLAGS_pbstream_filename.c_str(), &existing) == 0 &&
         !S_ISREG(existing.st_mode) && !S_ISDIR(existing.st_mode);
}

// Leaves the loops that were switched off out of a map just written.
absl::Status RemoveSwitchedLoops(const evaluation::SlamRun& run,
                                 const std::string& filename) {
  return io::CopyWithEditedPoseGraph(
      AtomicFileSet::NameToRead(filename), filename,
      [&run](cartographer::mapping::proto::PoseGraph* const pose_graph) {
        evaluation::MapGraph map;
        map.constraints = evaluation::MakeConstraints(*pose_graph);
        evaluation::DropConstraints(
            evaluation::MarkSwitchedOff(run.switched_loops.off, &map),
            pose_graph);
      });
}

}  // namespace

void NameSlamOutputs(const std::string& stem) {
  if (stem.empty()) return;
  const auto name = [&stem](std::string* const flag, const char* const ending) {
    if (flag->empty()) *flag = stem + ending;
  };
  name(&FLAGS_pbstream_filename, ".pbstream");
  name(&FLAGS_map_filestem, "");
  name(&FLAGS_picture_filename, ".png");
  if (!MapIsNoFile()) name(&FLAGS_report_filename, ".html");
}

absl::Status CheckSlamOutputs() {
  if (MapIsNoFile() &&
      (!FLAGS_report_filename.empty() || !FLAGS_keep_switched_loops)) {
    return absl::InvalidArgumentError(
        absl::StrCat(FLAGS_pbstream_filename,
                     ": is not a file, so the map cannot be read again for "
                     "-report_filename or -nokeep_switched_loops"));
  }
  std::vector<std::string> outputs = {FLAGS_pbstream_filename,
                                      FLAGS_picture_filename,
                                      FLAGS_report_filename,
                                      FLAGS_trajectory_filename,
                                      FLAGS_local_trajectory_filename,
                                      FLAGS_online_trajectory_filename,
                                      FLAGS_decisions_filename,
                                      FLAGS_switched_loops_filename,
                                      FLAGS_json};
  if (!FLAGS_map_filestem.empty()) {
    outputs.push_back(FLAGS_map_filestem + ".pgm");
    outputs.push_back(FLAGS_map_filestem + ".yaml");
  }
  return CheckWritable(outputs, {FLAGS_load_state_filename});
}

evaluation::MapGraph MarkedGraph(const evaluation::SlamRun& run) {
  evaluation::MapGraph graph =
      evaluation::MakeMapGraph(*run.map_builder->pose_graph());
  evaluation::MarkMatches(run.matches, &graph);
  evaluation::MarkSwitchedOff(run.switched_loops.off, &graph);
  return graph;
}

absl::Status WriteSlamResults(const evaluation::SlamRun& run,
                              const evaluation::MapGraph& graph) {
  if (!FLAGS_pbstream_filename.empty()) {
    const absl::Status status = evaluation::WritePbstream(
        run.map_builder.get(), FLAGS_pbstream_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_pbstream_filename.empty() && !MapIsNoFile()) {
    const absl::Status decisions = evaluation::WriteDecisionsBeside(
        FLAGS_pbstream_filename, run.decisions);
    if (!decisions.ok()) return decisions;
    const absl::Status matches =
        evaluation::WriteMatchesBeside(FLAGS_pbstream_filename, run.matches);
    if (!matches.ok()) return matches;
    if (!FLAGS_keep_switched_loops && !run.switched_loops.off.empty()) {
      const absl::Status removed =
          RemoveSwitchedLoops(run, FLAGS_pbstream_filename);
      if (!removed.ok()) return removed;
    }
  }
  if (!FLAGS_switched_loops_filename.empty()) {
    const absl::Status status = WriteFileAtomically(
        FLAGS_switched_loops_filename,
        optimization::SwitchedLoopsTable(run.switched_loops));
    if (!status.ok()) return status;
  }
  if (!FLAGS_trajectory_filename.empty()) {
    const absl::Status status = io::WriteTumTrajectory(
        run.global_scan_poses, FLAGS_trajectory_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_local_trajectory_filename.empty()) {
    const absl::Status status = io::WriteTumTrajectory(
        run.local_scan_poses, FLAGS_local_trajectory_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_online_trajectory_filename.empty()) {
    const absl::Status status = io::WriteTumTrajectory(
        run.online_scan_poses, FLAGS_online_trajectory_filename);
    if (!status.ok()) return status;
  }
  if (FLAGS_decisions_filename.empty()) return absl::OkStatus();
  return WriteFileAtomically(
      FLAGS_decisions_filename,
      run.decisions.empty()
          ? evaluation::DecisionTable(graph)
          : loop_closure::DecisionCsv(run.decisions.Parsed()));
}

absl::Status WritePaintedMap(
    const evaluation::MapGraph& graph,
    const std::function<absl::StatusOr<io::OccupancyMap>(double)>& paint) {
  if (FLAGS_map_filestem.empty() && FLAGS_picture_filename.empty()) {
    return absl::OkStatus();
  }
  auto map = paint(FLAGS_resolution);
  if (!map.ok()) return map.status();
  if (!FLAGS_map_filestem.empty()) {
    const absl::Status status = io::WriteOccupancyMap(*map, FLAGS_map_filestem);
    if (!status.ok()) return status;
  }
  if (!FLAGS_picture_filename.empty()) {
    return evaluation::WriteMapPicture(*std::move(map), graph,
                                       BaseName(FLAGS_input_filename),
                                       FLAGS_picture_filename);
  }
  return absl::OkStatus();
}

bool WritesMap() {
  return !FLAGS_pbstream_filename.empty() || !FLAGS_map_filestem.empty() ||
         !FLAGS_picture_filename.empty();
}

void PrintSlamOutputs(std::ostream& out) {
  std::vector<std::string> names = {
      FLAGS_pbstream_filename,         FLAGS_picture_filename,
      FLAGS_report_filename,           FLAGS_trajectory_filename,
      FLAGS_local_trajectory_filename, FLAGS_online_trajectory_filename,
      FLAGS_decisions_filename,        FLAGS_switched_loops_filename};
  if (!FLAGS_map_filestem.empty()) {
    names.push_back(FLAGS_map_filestem + ".yaml");
    names.push_back(FLAGS_map_filestem + ".pgm");
  }
  // Without loops or records of local SLAM there is none of these.
  for (const std::string& beside :
       {evaluation::DecisionCsvFilename(FLAGS_pbstream_filename),
        evaluation::MatchCsvFilename(FLAGS_pbstream_filename)}) {
    std::error_code error;
    if (!FLAGS_pbstream_filename.empty() &&
        std::filesystem::exists(beside, error)) {
      names.push_back(beside);
    }
  }
  names.erase(std::remove(names.begin(), names.end(), ""), names.end());
  names.erase(std::remove(names.begin(), names.end(), "-"), names.end());
  if (!names.empty())
    out << "Written    " << absl::StrJoin(names, ", ") << "\n";
}

}  // namespace tools
}  // namespace cartographer_ext
