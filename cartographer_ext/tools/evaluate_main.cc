// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: collection
// SOURCES: evaluate_many.cc job.cc
//
// cartographer_ext_evaluate: how good is a map?
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "cartographer_ext/collection/collection_run.h"
#include "cartographer_ext/collection/map_files.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/map/verdict/decision_table.h"
#include "cartographer_ext/map/verdict/evaluation_inputs.h"
#include "cartographer_ext/map/verdict/evaluation_report.h"
#include "cartographer_ext/map/verdict/map_evaluation.h"
#include "cartographer_ext/map/verdict/map_relations.h"
#include "cartographer_ext/report/map_runs.h"
#include "cartographer_ext/report/report.h"
#include "cartographer_ext/rerun/rerun_configuration.h"
#include "cartographer_ext/slam/decision_files.h"
#include "cartographer_ext/slam/match_files.h"
#include "cartographer_ext/tools/command_line.h"
#include "cartographer_ext/tools/evaluate_many.h"
#include "cartographer_ext/tools/slam_progress.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "",
              "Map to judge. Poses between nodes are interpolated in time, as "
              "in Cartographer's own tool. A folder, a pattern, or several "
              "maps without the flag: all are judged.");
DEFINE_string(
    trajectory_filename, "",
    "Estimated trajectory (TUM) with a pose at every scan, as "
    "cartographer_ext_slam writes. Stamps are matched to the nearest within "
    "-stamp_tolerance, otherwise interpolated. If a map is given as well, this "
    "trajectory is judged and the map is used for its loops.");
DEFINE_string(relations_filename, "",
              "Reference relations, one per line: t1 t2 x y z roll pitch yaw.");
DEFINE_string(reference_trajectory_filename, "", "Reference trajectory (TUM).");
DEFINE_int32(trajectory_id, -1,
             "Trajectory of the map to compare with ground truth; -1: the "
             "first that has nodes.");
DEFINE_double(stamp_tolerance, 0.001,
              "Seconds within which two stamps belong to the same scan.");
DEFINE_double(
    rpe_distance, 1.,
    "Path length in metres over which the relative error is computed.");
DEFINE_double(loop_tolerance, 0.5,
              "Largest error in metres of a loop that counts as right.");
DEFINE_bool(self_consistency, true,
            "Check the consistency of the scans, loops and odometry of the "
            "map; takes some seconds.");
DEFINE_string(
    rerun_configuration_directory, "",
    "Folders with Lua files, comma separated. If given, the pose graph of the "
    "map is re-run, with stock's options and with ours.");
DEFINE_string(rerun_configuration_basename, "",
              "Lua file with the pose graph options; default.lua if empty. "
              "Stock is the same file without our blocks.");
DEFINE_string(rerun_stock_configuration_basename, "",
              "Lua file for stock, if it is a different one.");
DEFINE_bool(
    rerun_follow_recording, true,
    "If the Lua file of the map is named, stock's optimisation uses the stored "
    "loops that the run has reproduced. Clouds are stored rounded to the "
    "millimetre, and runs are sensitive to that: otherwise a run soon finds "
    "loops of other nodes of the same visits.");
DEFINE_int32(num_background_threads, 2, "Threads of the re-run.");
DEFINE_string(match_records_filename, "",
              "Records of local SLAM, for the degeneracy along the path. "
              "Empty: those beside the map (MAP.nodes.pb), if any.");
DEFINE_string(report_filename, "",
              "Output: report as one HTML file; beside it the numbers (.json) "
              "and the loops with their evidence (.loop_evidence.csv).");
DEFINE_bool(times, true,
            "Report times and memory, which differ from run to run.");
DEFINE_string(constraints_filename, "",
              "Output: CSV of all constraints with residuals and, with ground "
              "truth, verdicts.");
DEFINE_string(relation_errors_filename, "",
              "Output: CSV of the error of every relation.");
DEFINE_string(
    write_relations, "",
    "Output: relations along the path and over the loops of a sound map, for "
    "tuning without ground truth; only as accurate as the map.");
DEFINE_string(fail_on, "",
              "Exit with code 3 if a map is broken; with doubtful, also if one "
              "is doubtful; with worse, if one is worse than in -baseline.");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Judges a map: relations metric, trajectory error, right and wrong loops.

  cartographer_ext_evaluate -pbstream_filename=map.pbstream
  cartographer_ext_evaluate -pbstream_filename=map.pbstream \
      -trajectory_filename=run.tum -relations_filename=aces.relations
  cartographer_ext_evaluate -trajectory_filename=run.tum \
      -reference_trajectory_filename=truth.tum -json=-
  cartographer_ext_evaluate -pbstream_filename=map.pbstream \
      -rerun_configuration_directory=configuration_files \
      -report_filename=map.html
  cartographer_ext_evaluate maps/ -report_filename=overview.html -fail_on=broken

Without ground truth the map is checked for self-consistency: scans against the
submaps of other visits, loops against each other, local SLAM against odometry.
The relations metric is that of Cartographer's compute_relations_metrics;
relations more than a minute apart close loops and are listed separately,
because a folded map looks fine in the others.)";

using evaluation::EvaluationInputs;

absl::StatusOr<EvaluationInputs> ReadInputs() {
  evaluation::EvaluationFiles files;
  files.pbstream = FLAGS_pbstream_filename;
  files.trajectory = FLAGS_trajectory_filename;
  files.relations = FLAGS_relations_filename;
  files.reference_trajectory = FLAGS_reference_trajectory_filename;
  evaluation::EvaluationUses uses;
  uses.contents = FLAGS_self_consistency || !FLAGS_report_filename.empty();
  uses.stored_grids = !FLAGS_rerun_configuration_directory.empty();
  return evaluation::ReadEvaluationInputs(files, uses);
}

evaluation::MapEvaluationOptions EvaluationOptions(
    const evaluation::MapGraph& graph) {
  evaluation::MapEvaluationOptions options;
  if (FLAGS_trajectory_id >= 0) {
    options.trajectory_id = FLAGS_trajectory_id;
  } else if (!graph.nodes.empty()) {
    options.trajectory_id = graph.nodes.begin()->first.trajectory_id;
  }
  const io::TimeNs tolerance = io::FromSeconds(FLAGS_stamp_tolerance);
  options.relations.stamp_tolerance = tolerance;
  options.trajectory.stamp_tolerance = tolerance;
  options.trajectory.rpe_distance = FLAGS_rpe_distance;
  options.loops.correct_translation = FLAGS_loop_tolerance;
  options.loops.stamp_tolerance = tolerance;
  return options;
}

// "map.html" -> "map" + `ending`.
std::string BesideReport(const std::string& ending) {
  return absl::StrCat(absl::StripSuffix(FLAGS_report_filename, ".html"),
                      ending);
}

absl::Status WriteTables(const EvaluationInputs& inputs,
                         const evaluation::Evaluation& result) {
  if (!FLAGS_constraints_filename.empty()) {
    const absl::Status status = WriteFileAtomically(
        FLAGS_constraints_filename,
        evaluation::ConstraintTable(inputs.graph, &*result.loops));
    if (!status.ok()) return status;
  }
  if (FLAGS_relation_errors_filename.empty()) return absl::OkStatus();
  return WriteFileAtomically(FLAGS_relation_errors_filename,
                             evaluation::RelationErrorTable(*result.relations));
}

absl::Status ReadDegeneracy(report::ReportData* const data) {
  const bool is_named = !FLAGS_match_records_filename.empty();
  if (!is_named && FLAGS_pbstream_filename.empty()) return absl::OkStatus();
  auto samples = report::ReadDegeneracy(
      is_named ? FLAGS_match_records_filename
               : evaluation::MatchRecordsFilename(FLAGS_pbstream_filename));
  if (samples.ok()) {
    data->degeneracy = *std::move(samples);
  } else if (is_named || !absl::IsNotFound(samples.status())) {
    return samples.status();
  }
  return absl::OkStatus();
}

absl::Status WriteReport(const report::ReportData& data,
                         const nlohmann::ordered_json& json) {
  const auto page = report::MakeReport(data);
  if (!page.ok()) return page.status();
  absl::Status status = WriteFileAtomically(FLAGS_report_filename, *page);
  if (status.ok()) {
    status = WriteFileAtomically(BesideReport(".loop_evidence.csv"),
                                 report::LoopsToCsv(data));
  }
  if (status.ok()) status = tools::WriteJson(json, BesideReport(".json"));
  return status;
}

absl::Status WriteMapRelations(const EvaluationInputs& inputs,
                               const evaluation::Evaluation& result) {
  if (FLAGS_write_relations.empty()) return absl::OkStatus();
  const auto relations = evaluation::MakeRelationsIfSound(
      inputs.graph, FLAGS_pbstream_filename, evaluation::Judge(result).word,
      {EvaluationOptions(inputs.graph).trajectory_id});
  if (!relations.ok()) return relations.status();
  return io::WriteRelations(
      *relations, FLAGS_write_relations,
      absl::StrCat("From ", tools::BaseName(FLAGS_pbstream_filename),
                   ", which was judged sound. No ground truth."));
}

// The runs over the map, for the report and the JSON. A map that cannot be run
// again still has its report: `run_again` says why.
absl::Status RunAgain(const EvaluationInputs& inputs,
                      report::ReportData* const data,
                      absl::Status* const run_again) {
  report::RunInputs runs;
  runs.pbstream = &*inputs.pbstream;
  runs.graph = &inputs.graph;
  runs.contents = FLAGS_self_consistency ? &inputs.contents : nullptr;
  runs.odometry = &inputs.odometry;
  runs.truth = &inputs.truth;
  runs.evaluation = EvaluationOptions(inputs.graph);
  runs.rerun.num_background_threads = FLAGS_num_background_threads;
  runs.rerun.follow_recording = FLAGS_rerun_follow_recording;
  std::vector<std::string> directories =
      absl::StrSplit(FLAGS_rerun_configuration_directory, ',');
  std::string basename = FLAGS_rerun_configuration_basename;
  if (basename.empty()) {
    basename = "default.lua";
    // The given folders may hold files of the user only.
    directories.push_back(tools::ConfigurationDirectories("").front());
  }
  const auto configuration = evaluation::LoadRerunConfiguration(
      directories, basename, FLAGS_rerun_stock_configuration_basename,
      inputs.graph);
  if (!configuration.ok()) return configuration.status();
  Progress progress("re-running", 0);
  runs.rerun.on_progress = [&progress](const int64_t nodes,
                                       const int64_t total) {
    progress.Update(nodes, absl::StrCat("of ", total, " nodes"));
  };
  const absl::Status status = report::AddReruns(runs, *configuration, data);
  progress.Finish();
  if (!status.ok()) {
    *run_again = absl::Status(
        status.code(), absl::StrCat(FLAGS_pbstream_filename,
                                    ": cannot be re-run: ", status.message()));
    data->notes.push_back(std::string(run_again->message()));
  }
  return absl::OkStatus();
}

// The records beside the map, if any; counts what was not accepted.
absl::Status ReadDecisionsBeside(evaluation::LoopStatistics* const loops,
                                 std::vector<proto::LoopDecision>* decisions) {
  auto beside = evaluation::ReadDecisions(
      evaluation::DecisionRecordsFilename(FLAGS_pbstream_filename));
  if (absl::IsNotFound(beside.status())) return absl::OkStatus();
  if (!beside.ok()) return beside.status();
  *decisions = *std::move(beside);
  const evaluation::DecisionCounts counts =
      evaluation::CountDecisions(*decisions);
  loops->rejected = counts.rejected + counts.undecided;
  return absl::OkStatus();
}

absl::Status CheckOutputs() {
  std::vector<std::string> outputs = {
      FLAGS_constraints_filename, FLAGS_relation_errors_filename, FLAGS_json,
      FLAGS_report_filename, FLAGS_write_relations};
  if (!FLAGS_report_filename.empty()) {
    outputs.push_back(BesideReport(".json"));
  }
  return tools::CheckWritable(outputs);
}

absl::Status RunOne(const std::string& command_line, bool* const fails) {
  const absl::Status writable = CheckOutputs();
  if (!writable.ok()) return writable;
  AtomicFileSet files;
  auto step = tools::ShowStep("judging the map");
  const auto read = ReadInputs();
  if (!read.ok()) return read.status();
  const EvaluationInputs& inputs = *read;

  evaluation::MapToEvaluate map;
  const bool has_map = inputs.pbstream.has_value();
  if (has_map) {
    map.graph = &inputs.graph;
    if (FLAGS_self_consistency) map.contents = &inputs.contents;
    map.odometry = &inputs.odometry;
  }
  if (inputs.trajectory.has_value()) map.scans = &*inputs.trajectory;
  auto result = evaluation::EvaluateMap(map, inputs.truth,
                                        EvaluationOptions(inputs.graph));
  step.reset();
  if (!result.ok()) {
    return absl::Status(result.status().code(),
                        absl::StrCat(has_map ? FLAGS_pbstream_filename
                                             : FLAGS_trajectory_filename,
                                     ": ", result.status().message()));
  }
  *fails = collection::FailsOn(evaluation::Judge(*result).word, FLAGS_fail_on);
  absl::Status status;
  std::vector<proto::LoopDecision> decisions;
  if (has_map && result->loops.has_value()) {
    status = ReadDecisionsBeside(&*result->loops, &decisions);
    if (!status.ok()) return status;
  }
  status = WriteTables(inputs, *result);
  if (status.ok()) status = WriteMapRelations(inputs, *result);
  if (!status.ok()) return status;

  report::ReportData data;
  if (has_map) {
    data.title = tools::BaseName(FLAGS_pbstream_filename);
    data.command_line = command_line;
    data.versions = report::Versions();
    data.contents = &inputs.contents;
    data.with_times = FLAGS_times;
    report::RunInputs stored;
    stored.graph = &inputs.graph;
    data.runs.push_back(report::StoredRun(stored, *result));
    data.runs.back().stored_decisions = std::move(decisions);
  }
  status = ReadDegeneracy(&data);
  if (!status.ok()) return status;
  absl::Status run_again;
  if (!FLAGS_rerun_configuration_directory.empty()) {
    status = RunAgain(inputs, &data, &run_again);
    if (!status.ok()) return status;
  }
  if (FLAGS_json != "-") {
    std::cout << evaluation::ToText(*result) << report::RunsToText(data);
  }
  nlohmann::ordered_json json = {{"pbstream", FLAGS_pbstream_filename},
                                 {"trajectory", FLAGS_trajectory_filename}};
  json.update(evaluation::ToJson(*result));
  if (data.runs.size() > 1) {
    json["runs"] = report::RunsToJson(data);
    json["assumptions"] = data.assumptions;
  }
  if (!FLAGS_report_filename.empty()) {
    step = tools::ShowStep("writing the report");
    status = WriteReport(data, json);
    if (!status.ok()) return status;
  }
  if (!FLAGS_json.empty()) status = tools::WriteJson(json, FLAGS_json);
  if (status.ok()) status = files.Commit();
  return status.ok() ? run_again : status;
}

// The message about wrong usage, or empty.
std::string WrongUsage(const bool many) {
  const std::string wrong = tools::WrongUsageOfMany(many);
  if (many || !wrong.empty()) return wrong;
  if (FLAGS_pbstream_filename.empty() && FLAGS_trajectory_filename.empty()) {
    return "-pbstream_filename or -trajectory_filename is needed";
  }
  if (FLAGS_pbstream_filename.empty() && FLAGS_relations_filename.empty() &&
      FLAGS_reference_trajectory_filename.empty()) {
    return "a trajectory alone cannot be judged: give -relations_filename or "
           "-reference_trajectory_filename";
  }
  if (FLAGS_pbstream_filename.empty() &&
      !(FLAGS_constraints_filename + FLAGS_write_relations).empty()) {
    return "-constraints_filename and -write_relations need -pbstream_filename";
  }
  if (!FLAGS_relation_errors_filename.empty() &&
      FLAGS_relations_filename.empty()) {
    return "-relation_errors_filename needs -relations_filename";
  }
  if (FLAGS_pbstream_filename.empty() &&
      (!FLAGS_report_filename.empty() ||
       !FLAGS_rerun_configuration_directory.empty())) {
    return "-report_filename and -rerun_configuration_directory need "
           "-pbstream_filename";
  }
  if (FLAGS_rerun_configuration_directory.empty() &&
      (!FLAGS_rerun_configuration_basename.empty() ||
       !FLAGS_rerun_stock_configuration_basename.empty())) {
    return "-rerun_configuration_basename needs -rerun_configuration_directory";
  }
  if (FLAGS_num_background_threads < 1) {
    return "-num_background_threads must be above 0";
  }
  if (!(FLAGS_stamp_tolerance >= 0.) || !(FLAGS_rpe_distance > 0.) ||
      !(FLAGS_loop_tolerance > 0.)) {
    return "-stamp_tolerance must not be negative, -rpe_distance and "
           "-loop_tolerance must be above 0";
  }
  return "";
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  const std::string command_line = absl::StrJoin(argv, argv + argc, " ");
  tools::CommandLine arguments(kDescription, "pbstream_filename");
  arguments.TakeMany();
  arguments.Parse(argc, argv);
  std::vector<std::string> inputs = arguments.more_inputs();
  const bool many =
      !inputs.empty() || collection::NamesMany(FLAGS_pbstream_filename);
  const std::string wrong = WrongUsage(many);
  if (!wrong.empty()) return tools::UsageError(wrong);
  bool fails = false;
  if (!many) {
    const absl::Status status = RunOne(command_line, &fails);
    return tools::ExitCode(status, fails);
  }
  inputs.push_back(FLAGS_pbstream_filename);
  return tools::EvaluateMany(inputs, &argc, &argv);
}
