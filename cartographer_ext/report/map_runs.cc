// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/map_runs.h"

#include "Eigen/Core"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/configuration/option_messages.h"
#include "cartographer_ext/map/host_types.h"
#include "cartographer_ext/slam/match_files.h"
#include "ceres/version.h"
#include "google/protobuf/stubs/common.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::Evaluation;

absl::StatusOr<ReportRun> RunOnce(
    const RunInputs& inputs,
    const cartographer::mapping::proto::PoseGraphOptions& options,
    const std::string& name, const std::string& style, const bool is_stock,
    const bool follow) {
  evaluation::RerunOptions rerun_options = inputs.rerun;
  rerun_options.follow_recording = follow;
  auto rerun =
      evaluation::RerunPoseGraph(*inputs.pbstream, options, rerun_options);
  if (!rerun.ok()) return rerun.status();
  ReportRun run;
  run.name = name;
  run.style = style;
  run.rerun = *std::move(rerun);
  run.rerun->name = name;
  run.graph = run.rerun->graph;
  evaluation::MapToEvaluate map;
  map.graph = &run.graph;
  map.contents = inputs.contents;
  map.odometry = inputs.odometry;
  auto evaluation =
      evaluation::EvaluateMap(map, *inputs.truth, inputs.evaluation);
  if (!evaluation.ok()) return evaluation.status();
  run.evaluation = *std::move(evaluation);
  evaluation::LoopComparisonOptions comparison;
  comparison.max_constraint_distance =
      options.constraint_builder_options().max_constraint_distance();
  // Ours decides by other rules.
  if (is_stock) comparison.outcomes = &run.rerun->outcomes;
  run.against_stored =
      evaluation::CompareLoops(*inputs.graph, run.graph, comparison);
  return run;
}

}  // namespace

ReportRun StoredRun(const RunInputs& inputs, Evaluation evaluation) {
  ReportRun run;
  run.name = "as stored";
  run.style = "s1";
  run.graph = *inputs.graph;
  run.evaluation = std::move(evaluation);
  return run;
}

absl::Status AddReruns(const RunInputs& inputs,
                       const evaluation::RerunConfiguration& configuration,
                       ReportData* const data) {
  data->stock_name = configuration.stock_name;
  data->ours_name = configuration.ours_name;
  data->assumptions = configuration.assumptions;
  data->stock_min_score =
      configuration.stock.constraint_builder_options().min_score();
  const bool follow =
      inputs.rerun.follow_recording && configuration.stock_is_known;
  auto stock = RunOnce(inputs, configuration.stock, "stock re-run", "s2",
                       true /* stock */, follow);
  if (!stock.ok()) return stock.status();
  if (follow) {
    data->assumptions.push_back(absl::StrFormat(
        "stock's run follows the record: its optimisation uses only the stored "
        "loops that the run has reproduced, with the stored poses where these "
        "are within 5 cm and 3 degrees (%d at the end), so that the rounding "
        "of the stored clouds does not accumulate; -norerun_follow_recording "
        "disables this",
        stock->rerun->followed_loops));
  }
  if (stock->rerun->placeholders > 0) {
    data->assumptions.push_back(absl::StrCat(
        stock->rerun->placeholders,
        " unfinished submaps are not in the file; empty ones that are never "
        "searched represent them"));
  }
  if (stock->rerun->guessed_insertions > 0) {
    data->assumptions.push_back(
        absl::StrCat("submaps have been trimmed from the map; ",
                     stock->rerun->guessed_insertions,
                     " nodes beside the gaps are constrained to one submap "
                     "more or less than before"));
  }
  data->runs.push_back(*std::move(stock));
  if (!configuration.ours.has_value()) {
    data->notes.push_back(
        "Only stock was re-run: no configuration with our blocks was given "
        "(-rerun_configuration_basename).");
    return absl::OkStatus();
  }
  auto ours = RunOnce(inputs, *configuration.ours, "ours", "s3",
                      false /* stock */, false);
  if (!ours.ok()) return ours.status();
  data->runs.push_back(*std::move(ours));
  data->option_differences =
      evaluation::DescribeDifferences(configuration.stock, *configuration.ours);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<DegeneracySample>> ReadDegeneracy(
    const std::string& filename) {
  const auto records = evaluation::ReadMatches(filename);
  if (!records.ok()) return records.status();
  std::vector<DegeneracySample> samples;
  for (const proto::MatchRecord& record : *records) {
    if (!record.is_node()) continue;
    DegeneracySample sample;
    sample.time = evaluation::FromHostTicks(record.time());
    sample.ratio = record.information_ratio();
    sample.direction = record.weak_direction();
    sample.degenerate = record.degeneracy() != proto::MatchRecord::NONE;
    samples.push_back(sample);
  }
  return samples;
}

std::vector<std::pair<std::string, std::string>> Versions() {
  return {{"cartographer_ext", CARTOGRAPHER_EXT_VERSION},
          {"Cartographer", CARTOGRAPHER_EXT_HOST},
          {"Ceres Solver", CERES_VERSION_STRING},
          {"Eigen", absl::StrCat(EIGEN_WORLD_VERSION, ".", EIGEN_MAJOR_VERSION,
                                 ".", EIGEN_MINOR_VERSION)},
          {"Protocol Buffers",
           google::protobuf::internal::VersionString(GOOGLE_PROTOBUF_VERSION)},
          {"compiler", __VERSION__}};
}

}  // namespace report
}  // namespace cartographer_ext
