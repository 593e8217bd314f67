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

namespace {

absl::Status InFile(const std::string& filename, const absl::Status& status) {
  return absl::Status(status.code(),
                      absl::StrCat(filename, ": ", status.message()));
}

}  // namespace

absl::StatusOr<std::unique_ptr<JudgedMap>> JudgeMap(
    const std::string& pbstream_filename) {
  auto judged = std::make_unique<JudgedMap>();
  judged->filename = pbstream_filename;
  std::map<int, evaluation::Trajectory> odometry;
  {
    auto file = evaluation::ReadMapFile(pbstream_filename, {});
    if (!file.ok()) return file.status();
    judged->graph = evaluation::MakeMapGraph(file->pbstream);
    judged->contents = std::move(file->contents);
    odometry = evaluation::ReadOdometry(file->pbstream);
  }
  evaluation::MapToEvaluate map;
  map.graph = &judged->graph;
  map.contents = &judged->contents;
  map.odometry = &odometry;
  evaluation::MapEvaluationOptions options;
  if (!judged->graph.nodes.empty()) {
    options.trajectory_id = judged->graph.nodes.begin()->first.trajectory_id;
  }
  auto evaluation = evaluation::EvaluateMap(map, {}, options);
  if (!evaluation.ok()) return InFile(pbstream_filename, evaluation.status());
  judged->evaluation = *std::move(evaluation);
  return judged;
}

absl::StatusOr<std::string> MakeMapPage(const JudgedMap& map,
                                        const std::string& title,
                                        const std::string& command_line) {
  ReportData data;
  data.title = title;
  data.command_line = command_line;
  data.versions = Versions();
  data.contents = &map.contents;
  RunInputs inputs;
  inputs.graph = &map.graph;
  data.runs.push_back(StoredRun(inputs, map.evaluation));
  auto decisions = evaluation::ReadDecisions(
      evaluation::DecisionRecordsFilename(map.filename));
  if (decisions.ok()) {
    data.runs.back().stored_decisions = *std::move(decisions);
  } else if (!absl::IsNotFound(decisions.status())) {
    return decisions.status();
  }
  auto degeneracy =
      ReadDegeneracy(evaluation::MatchRecordsFilename(map.filename));
  if (degeneracy.ok()) {
    data.degeneracy = *std::move(degeneracy);
  } else if (!absl::IsNotFound(degeneracy.status())) {
    return degeneracy.status();
  }
  auto page = MakeReport(data);
  if (!page.ok()) return InFile(map.filename, page.status());
  return page;
}

}  // namespace report
}  // namespace cartographer_ext
