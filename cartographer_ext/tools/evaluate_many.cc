// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/evaluate_many.h"

#include <iostream>

#include "absl/status/status.h"
#include "cartographer_ext/collection/collection_run.h"
#include "cartographer_ext/collection/map_files.h"
#include "cartographer_ext/tools/command_line.h"
#include "cartographer_ext/tools/job.h"
#include "gflags/gflags.h"

DECLARE_string(trajectory_filename);
DECLARE_string(relations_filename);
DECLARE_string(reference_trajectory_filename);
DECLARE_string(rerun_configuration_directory);
DECLARE_string(constraints_filename);
DECLARE_string(match_records_filename);
DECLARE_string(write_relations);
DECLARE_bool(self_consistency);
DECLARE_string(report_filename);
DECLARE_string(fail_on);
DECLARE_string(json);

DEFINE_int32(workers, 0,
             "Many maps: number of worker processes; 0: one per hardware "
             "thread. Under mpirun the other ranks are the workers.");
DEFINE_double(max_map_cpu_seconds, 3600.,
              "Many maps: limit of the CPU seconds per map, beyond which it "
              "counts as failed; 0: no limit.");
DEFINE_string(journal_filename, "",
              "Many maps: journal of finished maps. An interrupted command "
              "resumes when it is started again with the same journal.");
DEFINE_string(baseline, "",
              "Many maps: -json_lines_filename of an earlier run; what has "
              "become worse or better since is reported.");
DEFINE_string(reports_directory, "",
              "Output, many maps: folder for a report of each map, linked from "
              "the overview (-report_filename).");
DEFINE_string(csv_filename, "", "Output, many maps: CSV with one row per map.");
DEFINE_string(json_lines_filename, "",
              "Output, many maps: one line of JSON per map.");
namespace cartographer_ext {
namespace tools {
namespace {

absl::Status RunMany(const std::vector<std::string>& maps, const Job& job,
                     bool* const fails) {
  collection::CollectionFiles files;
  files.overview = FLAGS_report_filename;
  files.reports_directory = FLAGS_reports_directory;
  files.csv = FLAGS_csv_filename;
  files.json_lines = FLAGS_json_lines_filename;
  files.journal = job.JournalOr(FLAGS_journal_filename);
  files.baseline = FLAGS_baseline;
  std::vector<std::string> inputs = maps;
  inputs.push_back(files.baseline);
  const absl::Status writable = CheckWritable(
      {files.overview, files.csv, files.json_lines, FLAGS_json}, inputs);
  if (!writable.ok()) return writable;
  const auto pool = job.CreatePool(FLAGS_workers, FLAGS_max_map_cpu_seconds,
                                   &collection::AnswerMapRequest);
  if (!pool.ok()) return pool.status();
  const auto result = collection::RunCollection(maps, files, pool->get());
  if (!result.ok()) return result.status();
  *fails = collection::FailsOn(*result, FLAGS_fail_on);
  if (FLAGS_json != "-") std::cout << collection::ToText(*result);
  if (!FLAGS_json.empty()) {
    const absl::Status status =
        WriteJson(collection::ToJson(*result), FLAGS_json);
    if (!status.ok()) return status;
  }
  return collection::CheckAllJudged(result->records);
}

}  // namespace

std::string WrongUsageOfMany(const bool many) {
  if (!collection::IsFailOn(FLAGS_fail_on)) {
    return "-fail_on must be broken, doubtful or worse";
  }
  if (!many) {
    return FLAGS_fail_on == "worse" || !FLAGS_baseline.empty() ||
                   !FLAGS_journal_filename.empty() ||
                   !FLAGS_reports_directory.empty() ||
                   !FLAGS_csv_filename.empty() ||
                   !FLAGS_json_lines_filename.empty()
               ? "-fail_on=worse, -baseline, -journal_filename, "
                 "-reports_directory, -csv_filename and -json_lines_filename "
                 "are for many maps"
               : "";
  }
  if (!FLAGS_trajectory_filename.empty() || !FLAGS_relations_filename.empty() ||
      !FLAGS_reference_trajectory_filename.empty() ||
      !FLAGS_rerun_configuration_directory.empty() ||
      !FLAGS_constraints_filename.empty() ||
      !FLAGS_match_records_filename.empty() || !FLAGS_write_relations.empty() ||
      !FLAGS_self_consistency) {
    return "ground truth, re-runs, constraints, relations and "
           "-noself_consistency are for one map";
  }
  if (FLAGS_workers < 0 || !(FLAGS_max_map_cpu_seconds >= 0.)) {
    return "-workers and -max_map_cpu_seconds must not be negative";
  }
  if (FLAGS_fail_on == "worse" && FLAGS_baseline.empty()) {
    return "-fail_on=worse needs -baseline";
  }
  return "";
}

int EvaluateMany(const std::vector<std::string>& inputs, int* const argc,
                 char*** const argv) {
  const std::string wrong = Job::WrongUsage();
  if (!wrong.empty()) return UsageError(wrong);
  const Job job(argc, argv);
  if (job.is_worker()) {
    return ExitCode(job.Serve(FLAGS_workers, FLAGS_max_map_cpu_seconds,
                              &collection::AnswerMapRequest));
  }
  const auto maps = collection::FindMaps(inputs);
  if (!maps.ok()) return ExitCode(maps.status());
  bool fails = false;
  const absl::Status status = RunMany(*maps, job, &fails);
  return ExitCode(status, fails);
}

}  // namespace tools
}  // namespace cartographer_ext
