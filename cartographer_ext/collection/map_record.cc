// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/collection/map_record.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/io/bounded_json.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/report/map_report.h"
#include "cartographer_ext/report/png_image.h"
#include "cartographer_ext/tuning/workers/worker_pool.h"

namespace cartographer_ext {
namespace collection {
namespace {

using nlohmann::ordered_json;

constexpr double kPixels = 144.;       // longer side of a small picture
constexpr double kFinestCells = 0.05;  // metres
constexpr int kFinerBy = 4;            // painted finer, so that walls remain

// Each cell takes the most occupied of those it covers.
io::OccupancyMap Shrink(const io::OccupancyMap& map, const int factor) {
  io::OccupancyMap small = io::OccupancyMap::Make(
      (map.width + factor - 1) / factor, (map.height + factor - 1) / factor,
      map.resolution * factor, map.origin);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      float& cell = small.at(x / factor, y / factor);
      const float occupancy = map.at(x, y);
      if (std::isnan(cell) || occupancy > cell) cell = occupancy;
    }
  }
  return small;
}

std::string SmallPicture(const report::JudgedMap& map) {
  // Once coarsely for the size, then at the size wanted.
  auto painted = evaluation::PaintContents(map.graph, map.contents, 0.5);
  if (!painted.ok()) return "";
  const double side =
      painted->resolution * std::max(painted->width, painted->height);
  const double cells = std::max(kFinestCells, side / kPixels / kFinerBy);
  painted = evaluation::PaintContents(map.graph, map.contents, cells);
  if (!painted.ok()) return "";
  const int pixels = static_cast<int>(kPixels);
  const int longer = std::max(painted->width, painted->height);
  return report::MapDataUri(
      Shrink(*painted, std::max(1, (longer + pixels - 1) / pixels)));
}

MapRecord MakeRecord(const report::JudgedMap& map) {
  MapRecord record;
  record.filename = map.filename;
  const evaluation::Verdict verdict = evaluation::Judge(map.evaluation);
  record.verdict = verdict.word;
  record.reasons = verdict.reasons;
  record.nodes = static_cast<int64_t>(map.graph.nodes.size());
  record.submaps = static_cast<int64_t>(map.graph.submaps.size());
  record.loops = map.graph.num_loops();
  record.path = map.evaluation.trajectory_metres;
  if (map.evaluation.consistency.has_value()) {
    const evaluation::SelfConsistency& consistency =
        *map.evaluation.consistency;
    record.severe_share = consistency.severe_share;
    record.open_cycles = consistency.cycles.fraction();
    record.wall_doubling = consistency.sharpness.doubling;
    record.wrong_turns = static_cast<int64_t>(consistency.wrong_turns.size());
  }
  record.picture = SmallPicture(map);
  return record;
}

std::string Quoted(const std::string& text) {
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

}  // namespace

int Severity(const std::string& verdict) {
  if (verdict == "doubtful") return 1;
  if (verdict == "broken") return 2;
  return verdict == "failed" ? 3 : 0;
}

ordered_json ToJson(const MapRecord& record) {
  return {{"filename", record.filename},
          {"verdict", record.verdict},
          {"reasons", record.reasons},
          {"nodes", record.nodes},
          {"submaps", record.submaps},
          {"loops", record.loops},
          {"trajectory_metres", record.path},
          {"severe_share", record.severe_share},
          {"open_cycles", record.open_cycles},
          {"wall_doubling", record.wall_doubling},
          {"wrong_turns", record.wrong_turns},
          {"report", record.report},
          {"picture", record.picture}};
}

absl::StatusOr<MapRecord> RecordFromJson(const nlohmann::json& json) {
  MapRecord record;
  if (json.is_object()) {
    record.filename = io::TextIn(json, "filename");
    record.verdict = io::TextIn(json, "verdict");
  }
  if (record.filename.empty() || record.verdict.empty()) {
    return absl::InvalidArgumentError("not a record of a map");
  }
  const auto reasons = json.find("reasons");
  if (reasons != json.end() && reasons->is_array()) {
    for (const auto& reason : *reasons) {
      if (reason.is_string()) record.reasons.push_back(reason);
    }
  }
  record.nodes = io::CountIn(json, "nodes", 0);
  record.submaps = io::CountIn(json, "submaps", 0);
  record.loops = io::CountIn(json, "loops", 0);
  record.path = io::NumberIn(json, "trajectory_metres", 0.);
  record.severe_share = io::NumberIn(json, "severe_share", 0.);
  record.open_cycles = io::NumberIn(json, "open_cycles", 0.);
  record.wall_doubling = io::NumberIn(json, "wall_doubling", 1.);
  record.wrong_turns = io::CountIn(json, "wrong_turns", 0);
  record.report = io::TextIn(json, "report");
  record.picture = io::TextIn(json, "picture");
  return record;
}

std::string ToJsonLines(const std::vector<MapRecord>& records) {
  std::string lines;
  for (const MapRecord& record : records) {
    ordered_json json = ToJson(record);
    json.erase("picture");
    absl::StrAppend(
        &lines,
        json.dump(-1, ' ', false, ordered_json::error_handler_t::replace),
        "\n");
  }
  return lines;
}

std::string ToCsv(const std::vector<MapRecord>& records) {
  std::string csv =
      "filename,verdict,nodes,submaps,loops,trajectory_metres,severe_share,"
      "open_cycles,wall_doubling,wrong_turns,reasons\n";
  for (const MapRecord& record : records) {
    absl::StrAppendFormat(&csv, "%s,%s,%d,%d,%d,%.3f,%.6f,%.6f,%.4f,%d,%s\n",
                          Quoted(record.filename), record.verdict, record.nodes,
                          record.submaps, record.loops, record.path,
                          record.severe_share, record.open_cycles,
                          record.wall_doubling, record.wrong_turns,
                          Quoted(absl::StrJoin(record.reasons, "; ")));
  }
  return csv;
}

nlohmann::json AnswerMapRequest(const nlohmann::json& request) {
  const std::string filename = io::TextIn(request, "filename");
  const std::string page_filename = io::TextIn(request, "report");
  const auto map = report::JudgeMap(filename);
  if (!map.ok()) return tuning::Failure(std::string(map.status().message()));
  MapRecord record = MakeRecord(**map);
  if (!page_filename.empty()) {
    const auto page = report::MakeMapPage(
        **map, filename, absl::StrCat("cartographer_ext_evaluate ", filename));
    const absl::Status status =
        page.ok() ? WriteFileAtomically(page_filename, *page) : page.status();
    if (!status.ok()) return tuning::Failure(std::string(status.message()));
    record.report = page_filename;
  }
  return {{"ok", true}, {"metrics", ToJson(record)}};
}

}  // namespace collection
}  // namespace cartographer_ext
