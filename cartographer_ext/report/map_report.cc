// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/map_report.h"

#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/verdict/map_evaluation.h"
#include "cartographer_ext/report/map_runs.h"
#include "cartographer_ext/report/report.h"
#include "cartographer_ext/slam/decision_files.h"
#include "cartographer_ext/slam/match_files.h"

namespace cartographer_ext {
namespace report {

absl::StatusOr<MapReport> ReportMap(const std::string& pbstream_filename,
                                    const std::string& title,
                                    const std::string& command_line) {
  const auto pbstream = io::ReadPbstream(pbstream_filename);
  if (!pbstream.ok()) return pbstream.status();
  const evaluation::MapGraph graph = evaluation::MakeMapGraph(*pbstream);
  const evaluation::MapContents contents =
      evaluation::ReadMapContents(*pbstream, {});
  const std::map<int, evaluation::Trajectory> odometry =
      evaluation::ReadOdometry(*pbstream);
  evaluation::MapToEvaluate map;
  map.graph = &graph;
  map.contents = &contents;
  map.odometry = &odometry;
  const auto in_file = [&](const absl::Status& status) {
    return absl::Status(
        status.code(), absl::StrCat(pbstream_filename, ": ", status.message()));
  };
  evaluation::MapEvaluationOptions options;
  if (!graph.nodes.empty()) {
    options.trajectory_id = graph.nodes.begin()->first.trajectory_id;
  }
  auto evaluation = evaluation::EvaluateMap(map, {}, options);
  if (!evaluation.ok()) return in_file(evaluation.status());

  ReportData data;
  data.title = title;
  data.command_line = command_line;
  data.versions = Versions();
  data.pbstream = &*pbstream;
  data.contents = &contents;
  RunInputs inputs;
  inputs.graph = &graph;
  data.runs.push_back(StoredRun(inputs, *evaluation));
  auto decisions = evaluation::ReadDecisions(
      evaluation::DecisionRecordsFilename(pbstream_filename));
  if (decisions.ok()) {
    data.runs.back().stored_decisions = *std::move(decisions);
  } else if (!absl::IsNotFound(decisions.status())) {
    return decisions.status();
  }
  auto degeneracy =
      ReadDegeneracy(evaluation::MatchRecordsFilename(pbstream_filename));
  if (degeneracy.ok()) {
    data.degeneracy = *std::move(degeneracy);
  } else if (!absl::IsNotFound(degeneracy.status())) {
    return degeneracy.status();
  }
  auto page = MakeReport(data);
  if (!page.ok()) return in_file(page.status());
  return MapReport{*std::move(evaluation), *std::move(page)};
}

}  // namespace report
}  // namespace cartographer_ext
