// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: experiments
//
// cartographer_ext_label_loops: which loop candidates are true, and how well do
// the scores tell them apart?
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/experiments/labelled_loops.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/io/relations_file.h"
#include "cartographer_ext/io/trajectory_file.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/verdict/loop_statistics.h"
#include "cartographer_ext/slam/decision_files.h"
#include "cartographer_ext/slam/open_recording.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(input_filename, "",
              "Recording: CARMEN log, ROS 1 bag or world file.");
DEFINE_string(pbstream_filename, "",
              "Instead of a recording: a finished map with its decision "
              "records beside it (<stem>.loops.pb).");
DEFINE_string(configuration_directory, "",
              "Folders that are searched for Lua files, comma separated. "
              "Empty: the files installed with this command.");
DEFINE_string(configuration_basename, "default.lua",
              "Configuration with our loop closure.");
DEFINE_string(stock_configuration_basename, "stock.lua",
              "Configuration for comparison; empty: none.");
DEFINE_string(relations_filename, "",
              "Ground truth: reference relations, one per line: t1 t2 x y z "
              "roll pitch yaw.");
DEFINE_string(
    reference_trajectory_filename, "",
    "Ground truth: trajectory (TUM), for example a carefully optimised one.");
DEFINE_double(loop_tolerance, 0.5,
              "Largest error in metres of a loop that counts as true.");
DEFINE_double(stamp_tolerance, 0.001,
              "Seconds within which two stamps belong to the same scan.");
DEFINE_int32(num_background_threads, 0,
             "Threads of the back end; 0: as in the configuration.");
DEFINE_uint64(seed, 0, "Worlds: seed of noise and faults.");
DEFINE_string(csv_filename, "", "Output: every candidate with its label.");
DEFINE_string(picture_filename, "",
              "Output: ROC and precision-recall curves of the scores, and "
              "reliability of the probability (.svg).");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

using evaluation::LoopStatistics;
using evaluation::LoopStatisticsOptions;

constexpr char kDescription[] =
    R"(Labels every loop candidate as true or false and reports how well the scores separate them.

  cartographer_ext_label_loops -input_filename=aces.clf \
      -relations_filename=aces.relations -csv_filename=loops.csv \
      -picture_filename=loops.svg -json=-

Runs the recording with our loop closure and, for comparison, with
Cartographer's. Precision is the share of true loops among the accepted ones
that ground truth covers, recall the share of revisits closed by a true loop.
The reliability diagram compares the probability of candidates with the share of
true ones, in ten bins.)";

struct Truth {
  absl::optional<std::vector<evaluation::Relation>> relations;
  absl::optional<evaluation::Trajectory> reference;
};

absl::StatusOr<Truth> ReadTruth() {
  Truth truth;
  if (!FLAGS_relations_filename.empty()) {
    auto relations = io::ReadRelations(FLAGS_relations_filename);
    if (!relations.ok()) return relations.status();
    truth.relations = *std::move(relations);
  } else {
    auto poses = io::ReadTumTrajectory(FLAGS_reference_trajectory_filename);
    if (!poses.ok()) return poses.status();
    truth.reference = evaluation::Trajectory(*std::move(poses));
  }
  return truth;
}

LoopStatistics JudgeLoops(const evaluation::MapGraph& graph,
                          const Truth& truth) {
  LoopStatisticsOptions options;
  options.correct_translation = FLAGS_loop_tolerance;
  options.stamp_tolerance = io::FromSeconds(FLAGS_stamp_tolerance);
  return truth.relations.has_value() ? evaluation::ComputeLoopStatistics(
                                           graph, *truth.relations, options)
                                     : evaluation::ComputeLoopStatistics(
                                           graph, *truth.reference, options);
}

absl::StatusOr<evaluation::SlamRun> RunWith(const std::string& basename) {
  const std::vector<std::string> directories =
      tools::ConfigurationDirectories(FLAGS_configuration_directory);
  const auto configuration =
      evaluation::LoadSlamConfiguration(directories, basename);
  if (!configuration.ok()) return configuration.status();
  const auto source = evaluation::OpenRecording(
      FLAGS_input_filename, evaluation::ToSourceOptions(configuration->sensors),
      FLAGS_seed);
  if (!source.ok()) return source.status();
  const bool is_first = basename == FLAGS_configuration_basename;
  tools::PrintNotes(configuration->warnings);
  if (is_first) tools::PrintNotes((*source)->info().warnings);
  evaluation::SlamRunOptions options;
  options.num_background_threads = FLAGS_num_background_threads;
  auto run = evaluation::RunSlam(*configuration, source->get(), options);
  if (run.ok() && is_first) tools::PrintNotes(run->warnings);
  return run;
}

nlohmann::ordered_json Number(const absl::optional<double>& value) {
  return value.has_value() ? nlohmann::ordered_json(*value)
                           : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json ToJson(const LoopStatistics& loops,
                              const int64_t searches,
                              const double search_cpu_seconds) {
  return {{"precision", Number(loops.precision)},
          {"recall", Number(loops.recall)},
          {"accepted", loops.accepted},
          {"judged", loops.judged},
          {"correct", loops.correct},
          {"revisits", loops.revisits},
          {"revisits_closed", loops.revisits_closed},
          {"searches", searches},
          {"search_cpu_seconds", search_cpu_seconds}};
}

// Whether candidates are right as often as their probabilities say.
nlohmann::ordered_json CalibrationJson(
    const std::vector<evaluation::LabelledLoop>& loops) {
  const auto bins = evaluation::ReliabilityDiagram(
      evaluation::Scores(loops, evaluation::ScoreKind::kProbability));
  nlohmann::ordered_json json = {
      {"expected_calibration_error",
       Number(evaluation::ExpectedCalibrationError(bins))},
      {"bins", nlohmann::ordered_json::array()}};
  for (const evaluation::ReliabilityBin& bin : bins) {
    json["bins"].push_back({{"count", bin.count},
                            {"mean_score", bin.mean_score},
                            {"true_share", bin.true_share}});
  }
  return json;
}

// The map of a run and why its loop candidates were accepted or not.
struct DecidedMap {
  evaluation::MapGraph graph;
  std::vector<proto::LoopDecision> decisions;
  int64_t searches = 0;
  double search_cpu_seconds = 0.;
};

absl::StatusOr<DecidedMap> RunOrReadMap() {
  DecidedMap map;
  std::string source = FLAGS_configuration_basename;
  if (FLAGS_pbstream_filename.empty()) {
    const auto run = RunWith(FLAGS_configuration_basename);
    if (!run.ok()) return run.status();
    map.graph = evaluation::MakeMapGraph(*run->map_builder->pose_graph());
    map.decisions = run->decisions.Parsed();
    map.searches = run->loop_searches;
    map.search_cpu_seconds = run->loop_search_cpu_seconds;
  } else {
    const auto pbstream = io::ReadPbstream(FLAGS_pbstream_filename);
    if (!pbstream.ok()) return pbstream.status();
    map.graph = evaluation::MakeMapGraph(*pbstream);
    source = evaluation::DecisionRecordsFilename(FLAGS_pbstream_filename);
    auto records = evaluation::ReadDecisions(source);
    if (records.status().code() == absl::StatusCode::kNotFound) {
      return absl::NotFoundError(absl::StrCat(
          FLAGS_pbstream_filename, ": the decision records, ", source,
          ", are not beside the map: cartographer_ext_slam writes them"));
    }
    if (!records.ok()) return records.status();
    map.decisions = *std::move(records);
  }
  if (map.decisions.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(source,
                     ": no loop candidates: the recording returns to no place, "
                     "or POSE_GRAPH.constraint_builder.cartographer_ext is not "
                     "set"));
  }
  return map;
}

absl::Status WriteLabels(const std::vector<evaluation::LabelledLoop>& loops) {
  if (!FLAGS_csv_filename.empty()) {
    const absl::Status status =
        WriteFileAtomically(FLAGS_csv_filename, evaluation::LabelledCsv(loops));
    if (!status.ok()) return status;
  }
  if (FLAGS_picture_filename.empty()) return absl::OkStatus();
  return WriteFileAtomically(
      FLAGS_picture_filename,
      evaluation::CurvesSvg(loops,
                            tools::BaseName(FLAGS_pbstream_filename.empty()
                                                ? FLAGS_input_filename
                                                : FLAGS_pbstream_filename)));
}

absl::Status Run() {
  const absl::Status writable = tools::CheckWritable(
      {FLAGS_csv_filename, FLAGS_picture_filename, FLAGS_json});
  if (!writable.ok()) return writable;
  const auto truth = ReadTruth();
  if (!truth.ok()) return truth.status();

  nlohmann::ordered_json json;
  json["input"] = FLAGS_input_filename;
  json["configuration"] = FLAGS_configuration_basename;
  if (!FLAGS_pbstream_filename.empty()) {
    json["pbstream"] = FLAGS_pbstream_filename;
  }
  const auto map = RunOrReadMap();
  if (!map.ok()) return map.status();
  const LoopStatistics ours = JudgeLoops(map->graph, *truth);
  std::vector<proto::LoopDecision> candidates;
  const evaluation::MapGraph candidate_graph =
      evaluation::CandidateGraph(map->graph, map->decisions, &candidates);
  const std::vector<evaluation::LabelledLoop> loops =
      evaluation::LabelLoops(candidates, JudgeLoops(candidate_graph, *truth));
  const evaluation::ChainRates chain = evaluation::RatesOfChain(loops);

  if (!loops.empty() && chain.true_candidates + chain.false_candidates == 0) {
    return absl::InvalidArgumentError(absl::StrCat(
        FLAGS_relations_filename, FLAGS_reference_trajectory_filename,
        ": the ground truth covers none of the ", loops.size(),
        " loop candidates; is it of another recording?"));
  }

  json["candidates"] = loops.size();
  json["judged_candidates"] = chain.true_candidates + chain.false_candidates;
  json["true_candidates"] = chain.true_candidates;
  const auto auc = [&](const evaluation::ScoreKind kind) {
    return Number(evaluation::AreaUnderCurve(evaluation::Scores(loops, kind)));
  };
  json["auc"] = {{"grid", auc(evaluation::ScoreKind::kGrid)},
                 {"temporal", auc(evaluation::ScoreKind::kTemporal)},
                 {"fused", auc(evaluation::ScoreKind::kFused)},
                 {"probability", auc(evaluation::ScoreKind::kProbability)}};
  json["calibration"] = CalibrationJson(loops);
  json["chain"] = {{"precision", Number(chain.precision())},
                   {"recall", Number(chain.recall())},
                   {"true_accepted", chain.true_accepted},
                   {"false_accepted", chain.false_accepted}};
  json["ours"] = ToJson(ours, map->searches, map->search_cpu_seconds);
  json["stock"] = {{"precision", nullptr}, {"recall", nullptr}};
  if (FLAGS_pbstream_filename.empty() &&
      !FLAGS_stock_configuration_basename.empty()) {
    const auto stock = RunWith(FLAGS_stock_configuration_basename);
    if (!stock.ok()) return stock.status();
    json["stock"] = ToJson(
        JudgeLoops(evaluation::MakeMapGraph(*stock->map_builder->pose_graph()),
                   *truth),
        stock->loop_searches, stock->loop_search_cpu_seconds);
  }

  AtomicFileSet files;
  absl::Status written = WriteLabels(loops);
  if (!written.ok()) return written;
  if (FLAGS_json != "-") {
    std::cout << absl::StrFormat(
        "%d candidates, %d true, %d false; accepted %d true, %d false\n",
        loops.size(), chain.true_candidates, chain.false_candidates,
        chain.true_accepted, chain.false_accepted);
    std::cout << json["auc"].dump() << "\n";
  }
  if (!FLAGS_json.empty()) written = tools::WriteJson(json, FLAGS_json);
  return written.ok() ? files.Commit() : written;
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  tools::CommandLine command_line(kDescription, "input_filename");
  command_line.TakeEndings("picture_filename", {".svg"});
  command_line.Parse(argc, argv);
  if (FLAGS_input_filename.empty() == FLAGS_pbstream_filename.empty()) {
    return tools::UsageError(
        "give one of -input_filename and -pbstream_filename");
  }
  if (FLAGS_relations_filename.empty() ==
      FLAGS_reference_trajectory_filename.empty()) {
    return tools::UsageError(
        "give one of -relations_filename and -reference_trajectory_filename");
  }
  if (FLAGS_num_background_threads < 0 || !(FLAGS_loop_tolerance > 0.) ||
      !(FLAGS_stamp_tolerance >= 0.)) {
    return tools::UsageError(
        "-num_background_threads and -stamp_tolerance must not be negative, "
        "-loop_tolerance must be above 0");
  }
  return tools::ExitCode(Run());
}
