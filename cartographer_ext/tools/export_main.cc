// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: slam_library verdict
//
// cartographer_ext_export: extracts maps, trajectories and graphs from a
// .pbstream.
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/g2o.h"
#include "cartographer_ext/io/line_reader.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/pbstream/pbstream_writer.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/map/map_picture.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/pbstream_optimization.h"
#include "cartographer_ext/map/pose_graph_export.h"
#include "cartographer_ext/map/switched_constraints.h"
#include "cartographer_ext/map/verdict/decision_table.h"
#include "cartographer_ext/slam/match_files.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"

DEFINE_string(pbstream_filename, "", "Map to read.");
DEFINE_string(trajectory_filename, "",
              "Output: optimised poses of the nodes (TUM: timestamp x y z qx "
              "qy qz qw; stamps in Unix seconds).");
DEFINE_int32(trajectory_id, -1,
             "Trajectory to write; -1: all of them, ordered by time.");
DEFINE_string(g2o_filename, "",
              "Output: pose graph as VERTEX_SE2 and EDGE_SE2. Of trajectory t, "
              "submap i is vertex 2000000 t + i and node j is vertex "
              "2000000 t + 1000000 + j.");
DEFINE_string(constraints_filename, "",
              "Output: CSV of all constraints with weights and residuals.");
DEFINE_string(switched_loops_filename, "",
              "Loops to mark in constraints and picture: the CSV written by "
              "-switched_loops_filename of cartographer_ext_slam.");
DEFINE_string(output_pbstream_filename, "",
              "Output: the map without these loops.");
DEFINE_string(map_filestem, "",
              "Output: occupancy map <stem>.pgm and <stem>.yaml, for "
              "map_server and nav2.");
DEFINE_double(resolution, 0.05, "Resolution of that map, metres per cell.");
DEFINE_string(nodes_filename, "",
              "Degenerate nodes and odometry faults to mark in the picture: "
              "the .nodes.pb written by cartographer_ext_slam. Empty: the one "
              "beside the map, if any.");
DEFINE_string(picture_filename, "",
              "Output: PNG of the map with path and loops.");

namespace cartographer_ext {
namespace {

constexpr size_t kMaxTableBytes = size_t{100} << 20;

constexpr char kDescription[] =
    R"(Exports trajectory, graph, constraints and map of a .pbstream, without ROS.

  cartographer_ext_export -pbstream_filename=map.pbstream \
      -trajectory_filename=map.tum -g2o_filename=map.g2o \
      -constraints_filename=map.csv -map_filestem=map -picture_filename=map.png)";

absl::Status ExportMap(const io::Pbstream& pbstream,
                       const evaluation::MapGraph& graph) {
  auto map = evaluation::PaintPbstreamMap(pbstream, FLAGS_resolution);
  if (!map.ok()) {
    return absl::Status(
        map.status().code(),
        absl::StrCat(FLAGS_pbstream_filename, ": ", map.status().message()));
  }
  if (!FLAGS_map_filestem.empty()) {
    const absl::Status status = io::WriteOccupancyMap(*map, FLAGS_map_filestem);
    if (!status.ok()) return status;
  }
  if (!FLAGS_picture_filename.empty()) {
    return evaluation::WriteMapPicture(*std::move(map), graph,
                                       tools::BaseName(FLAGS_pbstream_filename),
                                       FLAGS_picture_filename);
  }
  return absl::OkStatus();
}

// Marks the loops of -switched_loops_filename and returns their indices.
absl::StatusOr<std::vector<int>> MarkLoops(evaluation::MapGraph* const graph) {
  const auto text = io::ReadFile(FLAGS_switched_loops_filename, kMaxTableBytes);
  if (!text.ok()) return text.status();
  const auto off = optimization::ParseSwitchedLoopsTable(*text);
  if (!off.ok()) {
    return absl::Status(off.status().code(),
                        absl::StrCat(FLAGS_switched_loops_filename, ": ",
                                     off.status().message()));
  }
  return evaluation::MarkSwitchedOff(*off, graph);
}

// Marks the nodes by -nodes_filename, or by the file beside the map.
absl::Status MarkNodes(evaluation::MapGraph* const graph) {
  const bool is_given = !FLAGS_nodes_filename.empty();
  const auto records = evaluation::ReadMatches(
      is_given ? FLAGS_nodes_filename
               : evaluation::MatchRecordsFilename(FLAGS_pbstream_filename));
  if (records.ok()) {
    evaluation::MarkMatches(*records, graph);
  } else if (is_given || !absl::IsNotFound(records.status())) {
    return records.status();
  }
  return absl::OkStatus();
}

absl::Status Run() {
  std::vector<std::string> outputs = {
      FLAGS_trajectory_filename, FLAGS_g2o_filename, FLAGS_constraints_filename,
      FLAGS_picture_filename, FLAGS_output_pbstream_filename};
  if (!FLAGS_map_filestem.empty()) {
    outputs.push_back(FLAGS_map_filestem + ".pgm");
    outputs.push_back(FLAGS_map_filestem + ".yaml");
  }
  const absl::Status writable = tools::CheckWritable(outputs);
  if (!writable.ok()) return writable;
  const auto pbstream = io::ReadPbstream(FLAGS_pbstream_filename);
  if (!pbstream.ok()) return pbstream.status();
  evaluation::MapGraph graph = evaluation::MakeMapGraph(*pbstream);
  if (!FLAGS_picture_filename.empty()) {
    const absl::Status status = MarkNodes(&graph);
    if (!status.ok()) return status;
  }
  if (!FLAGS_switched_loops_filename.empty()) {
    const auto off = MarkLoops(&graph);
    if (!off.ok()) return off.status();
    if (!FLAGS_output_pbstream_filename.empty()) {
      io::Pbstream output = *pbstream;
      evaluation::DropConstraints(*off, &output);
      const absl::Status status =
          io::WritePbstream(output, FLAGS_output_pbstream_filename);
      if (!status.ok()) return status;
    }
  }
  if (!FLAGS_trajectory_filename.empty()) {
    const evaluation::Trajectory trajectory =
        FLAGS_trajectory_id < 0 ? graph.GlobalTrajectory()
                                : graph.GlobalTrajectory(FLAGS_trajectory_id);
    if (trajectory.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          FLAGS_pbstream_filename, ": no nodes",
          FLAGS_trajectory_id < 0
              ? ""
              : absl::StrCat(" in trajectory ", FLAGS_trajectory_id)));
    }
    const absl::Status status =
        io::WriteTumTrajectory(trajectory.poses(), FLAGS_trajectory_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_g2o_filename.empty()) {
    const auto g2o = evaluation::ToG2o(graph);
    if (!g2o.ok()) return g2o.status();
    const absl::Status status = io::WriteG2o(*g2o, FLAGS_g2o_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_constraints_filename.empty()) {
    const absl::Status status =
        WriteFileAtomically(FLAGS_constraints_filename,
                            evaluation::ConstraintTable(graph, nullptr));
    if (!status.ok()) return status;
  }
  if (!FLAGS_map_filestem.empty() || !FLAGS_picture_filename.empty()) {
    return ExportMap(*pbstream, graph);
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine(kDescription, "pbstream_filename").Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-pbstream_filename is missing");
  }
  if (FLAGS_trajectory_filename.empty() && FLAGS_g2o_filename.empty() &&
      FLAGS_constraints_filename.empty() && FLAGS_map_filestem.empty() &&
      FLAGS_picture_filename.empty() &&
      FLAGS_output_pbstream_filename.empty()) {
    return tools::UsageError("nothing to write: no output is named");
  }
  if (!FLAGS_output_pbstream_filename.empty() &&
      FLAGS_switched_loops_filename.empty()) {
    return tools::UsageError(
        "-output_pbstream_filename needs -switched_loops_filename");
  }
  AtomicFileSet files;
  absl::Status status = Run();
  if (status.ok()) status = files.Commit();
  return tools::ExitCode(status);
}
