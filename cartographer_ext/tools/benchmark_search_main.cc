// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: experiments
//
// Compares the scan matchers, the host's and ours, with golden vectors taken
// from the real Cartographer, and times them.
#include <algorithm>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/experiments/golden_search.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "",
              "The map that the golden vectors were made from.");
DEFINE_string(golden_filename, "",
              "CSV of search and refinement results of the real Cartographer.");
DEFINE_string(matcher, "both",
              "Matcher to run: stock (the host's), ours, or both in turn.");
DEFINE_int32(repeat, 1, "Repetitions per pair; the smallest CPU time counts.");
DEFINE_bool(all, false, "Print every pair, not only those that differ.");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace tools {
namespace {

using evaluation::GoldenMatcher;
using evaluation::GoldenOutcome;
using evaluation::GoldenReport;
using evaluation::GoldenTimes;

std::string MatcherName(const GoldenMatcher matcher) {
  return matcher == GoldenMatcher::kStock ? "stock" : "ours";
}

std::vector<GoldenMatcher> MatchersOfFlag(const std::string& name) {
  std::vector<GoldenMatcher> matchers;
  if (name == "stock" || name == "both") {
    matchers.push_back(GoldenMatcher::kStock);
  }
  if (name == "ours" || name == "both") {
    matchers.push_back(GoldenMatcher::kOurs);
  }
  return matchers;
}

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
        "line %3d  %-34s  %-5s  %s  search %8.0f us (%5.2f x golden)  %s\n",
        outcome.golden.line, PairName(outcome.golden),
        MatcherName(report.matcher),
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
      "%s: %d pairs, %d matches found, %d ties, %d mismatches\n",
      MatcherName(report.matcher), report.outcomes.size(), report.num_found,
      report.num_ties, report.num_mismatches);
  std::cout << absl::StrFormat(
      "largest deviation: score %.1e; search %.1e m; refinement %.1e m, %.1e "
      "rad, cost %.1e (relative)\n",
      report.max_score_deviation, report.max_translation_deviation,
      report.max_refined_translation_deviation,
      report.max_refined_rotation_deviation,
      report.max_relative_cost_deviation);
  if (report.matcher != GoldenMatcher::kOurs) return;
  const scan_matching::SearchStatistics& statistics = report.statistics;
  std::cout << absl::StrFormat(
      "poses %d; coarse nodes %d, opened %d; blocks %d, opened %d; %d searches "
      "ended by the coarse bounds\n",
      statistics.num_poses, statistics.coarse_scored,
      statistics.coarse_scored - statistics.coarse_pruned,
      statistics.blocks_scored, statistics.blocks_opened,
      report.num_rejected_early);
}

void PrintTimes(const std::vector<GoldenReport>& reports) {
  std::cout << "mean us     golden";
  for (const GoldenReport& report : reports) {
    std::cout << absl::StrFormat("%10s", MatcherName(report.matcher));
  }
  if (reports.size() == 2) std::cout << "  stock/ours";
  std::cout << "\n";
  const auto print = [&reports](
                         const char* const what, const double golden,
                         const std::function<double(const GoldenReport&)>& of) {
    std::cout << absl::StrFormat("%-8s%10.0f", what, golden);
    for (const GoldenReport& report : reports) {
      std::cout << absl::StrFormat("%10.0f", of(report));
    }
    if (reports.size() == 2) {
      std::cout << absl::StrFormat(
          "%12.2f", of(reports[0]) / std::max(1., of(reports[1])));
    }
    std::cout << "\n";
  };
  const GoldenTimes golden = MeanTimes(reports.front(), false);
  print("search", golden.search_microseconds, [](const GoldenReport& report) {
    return MeanTimes(report, true).search_microseconds;
  });
  print("refine", golden.refine_microseconds, [](const GoldenReport& report) {
    return MeanTimes(report, true).refine_microseconds;
  });
  print("build", golden.build_microseconds, [](const GoldenReport& report) {
    return MeanTimes(report, true).build_microseconds;
  });
  print("KiB", reports.front().mean_matcher_bytes / 1024.,
        [](const GoldenReport& report) {
          return report.mean_matcher_bytes / 1024.;
        });
}

nlohmann::ordered_json TimesToJson(const GoldenTimes& times) {
  nlohmann::ordered_json json;
  json["mean_search_microseconds"] = times.search_microseconds;
  json["mean_refine_microseconds"] = times.refine_microseconds;
  json["mean_build_microseconds"] = times.build_microseconds;
  return json;
}

nlohmann::ordered_json ToJson(const GoldenReport& report) {
  nlohmann::ordered_json json;
  json["matcher"] = MatcherName(report.matcher);
  json["pairs"] = report.outcomes.size();
  json["mismatches"] = report.num_mismatches;
  json["ties"] = report.num_ties;
  json["found"] = report.num_found;
  json.update(TimesToJson(MeanTimes(report, true)));
  json["mean_matcher_bytes"] = report.mean_matcher_bytes;
  json["largest_deviation"]["score"] = report.max_score_deviation;
  json["largest_deviation"]["search_translation"] =
      report.max_translation_deviation;
  json["largest_deviation"]["refined_translation"] =
      report.max_refined_translation_deviation;
  json["largest_deviation"]["refined_rotation"] =
      report.max_refined_rotation_deviation;
  json["largest_deviation"]["relative_cost"] =
      report.max_relative_cost_deviation;
  if (report.matcher == GoldenMatcher::kOurs) {
    const scan_matching::SearchStatistics& statistics = report.statistics;
    json["statistics"]["poses"] = statistics.num_poses;
    json["statistics"]["coarse_scored"] = statistics.coarse_scored;
    json["statistics"]["coarse_pruned"] = statistics.coarse_pruned;
    json["statistics"]["blocks_scored"] = statistics.blocks_scored;
    json["statistics"]["blocks_pruned"] = statistics.blocks_pruned;
    json["statistics"]["blocks_opened"] = statistics.blocks_opened;
    json["statistics"]["blocks_cut"] = statistics.blocks_cut;
    json["statistics"]["rejected_early"] = report.num_rejected_early;
  }
  json["mismatching_pairs"] = nlohmann::ordered_json::array();
  for (const GoldenOutcome& outcome : report.outcomes) {
    if (outcome.mismatch.empty()) continue;
    json["mismatching_pairs"].push_back({{"line", outcome.golden.line},
                                         {"pair", PairName(outcome.golden)},
                                         {"reason", outcome.mismatch}});
  }
  return json;
}

nlohmann::ordered_json ToJson(const std::vector<GoldenReport>& reports) {
  // What is asked for on the outermost level is the one matcher's, or ours.
  nlohmann::ordered_json json = ToJson(reports.back());
  json["golden"] = TimesToJson(MeanTimes(reports.front(), false));
  json["matchers"] = nlohmann::ordered_json::array();
  for (const GoldenReport& report : reports) {
    json["matchers"].push_back(ToJson(report));
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
  // Frees memory that is not needed any more.
  *pbstream = io::Pbstream();

  Progress progress("matching", static_cast<int64_t>(pairs->size()));
  evaluation::GoldenCheckOptions options;
  options.matchers = MatchersOfFlag(FLAGS_matcher);
  options.repeat = FLAGS_repeat;
  options.progress = [&progress](const int done) { progress.Update(done); };
  const std::vector<GoldenReport> reports =
      CheckGoldenPairs(*pairs, *map, options);
  progress.Finish();
  for (const GoldenReport& report : reports) {
    *num_mismatches += report.num_mismatches;
  }
  if (FLAGS_json != "-") {
    for (const GoldenReport& report : reports) PrintPairs(report);
    for (const GoldenReport& report : reports) PrintSummary(report);
    PrintTimes(reports);
  }
  return FLAGS_json.empty() ? absl::OkStatus()
                            : WriteJson(ToJson(reports), FLAGS_json);
}

}  // namespace
}  // namespace tools
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;
  tools::CommandLine command_line(
      "Checks the scan matchers, the host's and ours, against golden "
      "vectors.\n\nThe CSV has, for pairs of a submap and a node, the results "
      "of the real\nCartographer's branch-and-bound search and Ceres matcher. "
      "The search must find\nthe same pose and score (another pose with the "
      "same score is a tie); refinement,\nstarted from the golden pose, must "
      "end within 1 mm, 1 mrad and 1 % of cost. CPU\ntimes are printed beside "
      "the golden ones, which are from another machine.\n\n  "
      "cartographer_ext_benchmark_search -pbstream_filename map.pbstream \\\n  "
      "    -golden_filename map.search.csv -matcher both -repeat 3\n\n"
      "Mismatches give exit code 1.");
  command_line.TakeOneOf("matcher", {"stock", "ours", "both"});
  command_line.Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-pbstream_filename is missing");
  }
  if (FLAGS_golden_filename.empty()) {
    return tools::UsageError("-golden_filename is missing");
  }
  if (FLAGS_repeat < 1) return tools::UsageError("-repeat must be at least 1");
  int num_mismatches = 0;
  const int exit_code = tools::ExitCode(tools::Run(&num_mismatches));
  if (exit_code != tools::kExitSuccess) return exit_code;
  return num_mismatches == 0 ? tools::kExitSuccess : tools::kExitBadInput;
}
