// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: report
//
// cartographer_ext_compare: how do two maps of one place differ?
#include <iostream>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/optional.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/comparison/map_comparison.h"
#include "cartographer_ext/map/map_contents.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/map/verdict/self_consistency.h"
#include "cartographer_ext/report/comparison_report.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "",
              "First map (.pbstream), or the YAML file of a PGM.");
DEFINE_string(other_pbstream_filename, "",
              "Second map (.pbstream), or the YAML file of a PGM.");
DEFINE_double(wall_tolerance, 0.15,
              "Metres within which walls of the two maps count as the same.");
DEFINE_double(moved, 0.2,
              "Nodes that moved by more than this (metres) are listed.");
DEFINE_double(resolution, 0.05, "Resolution of the pictures, metres per cell.");
DEFINE_string(report_filename, "", "Output: report as one HTML file.");
DEFINE_string(json, "", "Output: all numbers as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Aligns two maps and reports their differences: walls, path, verdict.

  cartographer_ext_compare before.pbstream after.pbstream \
      -report_filename=comparison.html
  cartographer_ext_compare map.pbstream map.yaml -json=-

Maps of the same run are aligned by their common nodes, so that unchanged parts
coincide; maps of two runs by their walls.)";

struct Input {
  std::string name;
  io::OccupancyMap map;
  absl::optional<evaluation::MapGraph> graph;
  absl::optional<evaluation::SelfConsistency> consistency;
};

absl::StatusOr<Input> Read(const std::string& filename) {
  Input input;
  input.name = tools::BaseName(filename);
  if (absl::EndsWith(filename, ".yaml") || absl::EndsWith(filename, ".yml")) {
    auto map = io::ReadOccupancyMap(filename);
    if (!map.ok()) return map.status();
    input.map = *std::move(map);
    return input;
  }
  const auto file = evaluation::ReadMapFile(filename, {});
  if (!file.ok()) return file.status();
  input.graph = evaluation::MakeMapGraph(file->pbstream);
  auto map =
      evaluation::PaintContents(*input.graph, file->contents, FLAGS_resolution);
  if (!map.ok()) {
    return absl::Status(map.status().code(),
                        absl::StrCat(filename, ": ", map.status().message()));
  }
  input.map = *std::move(map);
  input.consistency = evaluation::AssessSelfConsistency(
      *input.graph, file->contents, evaluation::ReadOdometry(file->pbstream),
      {});
  return input;
}

report::ComparedMap Compared(const Input& input) {
  report::ComparedMap map;
  map.name = input.name;
  map.map = &input.map;
  if (input.graph.has_value()) map.graph = &*input.graph;
  if (input.consistency.has_value()) map.consistency = &*input.consistency;
  return map;
}

nlohmann::ordered_json VerdictJson(const Input& input,
                                   const std::string& filename) {
  nlohmann::ordered_json json;
  json["filename"] = filename;
  json["verdict"] = nullptr;
  json["severe_share"] = nullptr;
  if (input.consistency.has_value()) {
    json["verdict"] = input.consistency->word;
    json["severe_share"] = input.consistency->severe_share;
  }
  return json;
}

absl::Status Run(const std::string& command_line) {
  const absl::Status writable =
      tools::CheckWritable({FLAGS_report_filename, FLAGS_json});
  if (!writable.ok()) return writable;
  auto first = Read(FLAGS_pbstream_filename);
  if (!first.ok()) return first.status();
  auto second = Read(FLAGS_other_pbstream_filename);
  if (!second.ok()) return second.status();
  if (first->name == second->name) {
    first->name = FLAGS_pbstream_filename;
    second->name = FLAGS_other_pbstream_filename;
  }
  const report::ComparedMap a = Compared(*first), b = Compared(*second);
  evaluation::ComparisonOptions options;
  options.tolerance = FLAGS_wall_tolerance;
  options.moved = FLAGS_moved;
  const auto comparison =
      evaluation::CompareMaps({a.graph, a.map}, {b.graph, b.map}, options);
  if (!comparison.ok()) {
    return absl::Status(comparison.status().code(),
                        absl::StrCat(FLAGS_pbstream_filename, " and ",
                                     FLAGS_other_pbstream_filename, ": ",
                                     comparison.status().message()));
  }
  if (!FLAGS_report_filename.empty()) {
    const absl::Status status = WriteFileAtomically(
        FLAGS_report_filename,
        report::MakeComparisonReport(a, b, *comparison, command_line));
    if (!status.ok()) return status;
  }
  if (FLAGS_json != "-") {
    for (const report::ComparedMap* const map : {&a, &b}) {
      if (map->consistency == nullptr) continue;
      std::cout << map->name << ": " << map->consistency->word << ", "
                << map->consistency->reasons.front() << "\n";
    }
    std::cout << evaluation::ToText(*comparison);
  }
  if (FLAGS_json.empty()) return absl::OkStatus();
  nlohmann::ordered_json json = evaluation::ToJson(*comparison);
  json["first"] = VerdictJson(*first, FLAGS_pbstream_filename);
  json["second"] = VerdictJson(*second, FLAGS_other_pbstream_filename);
  return tools::WriteJson(json, FLAGS_json);
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  using namespace cartographer_ext;  // NOLINT
  const std::string command_line = absl::StrJoin(argv, argv + argc, " ");
  tools::CommandLine(kDescription, "pbstream_filename",
                     "other_pbstream_filename")
      .Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty() ||
      FLAGS_other_pbstream_filename.empty()) {
    return tools::UsageError("two maps are needed");
  }
  if (!(FLAGS_wall_tolerance > 0.) || !(FLAGS_moved > 0.) ||
      !(FLAGS_resolution > 0.)) {
    return tools::UsageError(
        "-wall_tolerance, -moved and -resolution must be above 0");
  }
  return tools::ExitCode(Run(command_line));
}
