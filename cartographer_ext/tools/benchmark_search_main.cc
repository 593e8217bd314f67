// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: evaluation
//
// Compares the host's scan matchers with golden vectors taken from the real
// Cartographer, and times them.
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/evaluation/golden_search.h"
#include "cartographer_ext/io/pbstream_reader.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "", "the state the golden vectors are about");
DEFINE_string(golden_filename, "",
              "CSV of search and refinement results of the real Cartographer");
DEFINE_bool(all, false, "print every pair, not only those that differ");
DEFINE_string(json, "", "write figures to this file; - is standard output");

namespace cartographer_ext {
namespace tools {
namespace {

using evaluation::GoldenOutcome;
using evaluation::GoldenReport;
using evaluation::GoldenTimes;

std::string PairName(const evaluation::GoldenPair& pair) {
  return absl::StrFormat(
      "%s submap %d:%d node %d:%d", pair.full_submap ? "full " : "local",
      pair.submap_id.trajectory_id, pair.submap_id.submap_index,
      pair.node_id.trajectory_id, pair.node_id.node_index);
}

void PrintPairs(const GoldenReport& report) {
  for (const GoldenOutcome& outcome : report.outcomes) {
    if (outcome.mismatch.empty() && !FLAGS_all) continue;
    std::cout << absl::StrFormat(
        "line %3d  %-34s  %s  search %8.0f us (%5.2f x golden)  %s\n",
        outcome.golden.line, PairName(outcome.golden),
        !outcome.ours.found ? "nothing       "
                            : absl::StrFormat("score %.6f", outcome.ours.score),
        outcome.ours.search_microseconds,
        outcome.ours.search_microseconds /
            std::max(1., outcome.golden.search_microseconds),
        !outcome.mismatch.empty() ? "MISMATCH: " + outcome.mismatch
        : outcome.tie             ? "tie"
                                  : "same");
  }
}

void PrintSummary(const GoldenReport& report) {
  std::cout << absl::StrFormat(
      "%d pairs, %d matches found, %d ties, %d mismatches\n",
      report.outcomes.size(), report.num_found, report.num_ties,
      report.num_mismatches);
  std::cout << absl::StrFormat(
      "largest deviation: score %.1e; search %.1e m; refinement %.1e m, %.1e "
      "rad, cost %.1e (relative)\n",
      report.max_score_deviation, report.max_translation_deviation,
      report.max_refined_translation_deviation,
      report.max_refined_rotation_deviation,
      report.max_relative_cost_deviation);
  const GoldenTimes ours = MeanTimes(report, true);
  const GoldenTimes golden = MeanTimes(report, false);
  const auto print_time = [](const char* const what, const double our_time,
                             const double golden_time) {
    std::cout << absl::StrFormat("%-7s %9.0f %9.0f %6.2f\n", what, our_time,
                                 golden_time,
                                 our_time / std::max(1., golden_time));
  };
  std::cout << "mean us      ours    golden  ratio\n";
  print_time("search", ours.search_microseconds, golden.search_microseconds);
  print_time("refine", ours.refine_microseconds, golden.refine_microseconds);
  print_time("build", ours.build_microseconds, golden.build_microseconds);
}

nlohmann::ordered_json ToJson(const GoldenReport& report) {
  const GoldenTimes ours = MeanTimes(report, true);
  const GoldenTimes golden = MeanTimes(report, false);
  nlohmann::ordered_json json;
  json["pairs"] = report.outcomes.size();
  json["mismatches"] = report.num_mismatches;
  json["ties"] = report.num_ties;
  json["found"] = report.num_found;
  json["mean_search_microseconds"] = ours.search_microseconds;
  json["mean_refine_microseconds"] = ours.refine_microseconds;
  json["mean_build_microseconds"] = ours.build_microseconds;
  json["golden"]["mean_search_microseconds"] = golden.search_microseconds;
  json["golden"]["mean_refine_microseconds"] = golden.refine_microseconds;
  json["golden"]["mean_build_microseconds"] = golden.build_microseconds;
  json["largest_deviation"]["score"] = report.max_score_deviation;
  json["largest_deviation"]["search_translation"] =
      report.max_translation_deviation;
  json["largest_deviation"]["refined_translation"] =
      report.max_refined_translation_deviation;
  json["largest_deviation"]["refined_rotation"] =
      report.max_refined_rotation_deviation;
  json["largest_deviation"]["relative_cost"] =
      report.max_relative_cost_deviation;
  json["mismatching_pairs"] = nlohmann::ordered_json::array();
  for (const GoldenOutcome& outcome : report.outcomes) {
    if (outcome.mismatch.empty()) continue;
    json["mismatching_pairs"].push_back({{"line", outcome.golden.line},
                                         {"pair", PairName(outcome.golden)},
                                         {"reason", outcome.mismatch}});
  }
  return json;
}

absl::Status Run(int* const num_mismatches) {
  const absl::Status writable = CheckWritable({FLAGS_json});
  if (!writable.ok()) return writable;
  const auto pairs = evaluation::ReadGoldenPairs(FLAGS_golden_filename);
  if (!pairs.ok()) return pairs.status();
  auto pbstream = io::ReadPbstream(FLAGS_pbstream_filename);
  if (!pbstream.ok()) return pbstream.status();
  const auto map = evaluation::GoldenMap::Create(*pbstream, *pairs);
  if (!map.ok()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s does not belong to %s: %s", FLAGS_golden_filename,
                        FLAGS_pbstream_filename, map.status().message()));
  }
  // Not needed any more, and large.
  *pbstream = io::Pbstream();

  Progress progress("matching", static_cast<int64_t>(pairs->size()));
  const GoldenReport report =
      CheckGoldenPairs(*pairs, *map, evaluation::GoldenTolerance(),
                       [&progress](const int done) { progress.Update(done); });
  progress.Finish();
  *num_mismatches = report.num_mismatches;
  if (FLAGS_json != "-") {
    PrintPairs(report);
    PrintSummary(report);
  }
  return FLAGS_json.empty() ? absl::OkStatus()
                            : WriteJson(ToJson(report), FLAGS_json);
}

}  // namespace
}  // namespace tools
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;
  tools::CommandLine command_line(
      "Checks the scan matchers of the host against golden vectors.\n\n"
      "For pairs of a submap and a node the CSV holds what the real "
      "Cartographer's\nbranch-and-bound search and Ceres matcher found. The "
      "search must find the same\npose and score (another pose with the same "
      "score is a tie); refinement, started\nfrom the golden pose, must end "
      "within 1 mm, 1 mrad and 1 % of cost. CPU times\nare printed beside the "
      "golden ones, which were taken on another machine.\n\n"
      "  cartographer_ext_benchmark_search -pbstream_filename map.pbstream \\\n"
      "      -golden_filename map.search.csv\n\n"
      "Exit codes: 0 all the same, 1 mismatches or bad input, 2 wrong usage.");
  command_line.Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-pbstream_filename is missing");
  }
  if (FLAGS_golden_filename.empty()) {
    return tools::UsageError("-golden_filename is missing");
  }
  int num_mismatches = 0;
  const int exit_code = tools::ExitCode(tools::Run(&num_mismatches));
  if (exit_code != tools::kExitSuccess) return exit_code;
  return num_mismatches == 0 ? tools::kExitSuccess : tools::kExitBadInput;
}
