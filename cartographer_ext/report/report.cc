// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/report/report.h"

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"
#include "cartographer_ext/report/style.h"

namespace cartographer_ext {
namespace report {
namespace {

using nlohmann::ordered_json;

// The longer side of a map's picture, and the finest cells worth drawing.
constexpr double kMaxPixels = 1100.;
constexpr double kFinestCells = 0.05;  // metres

double MapSide(const evaluation::MapGraph& graph,
               const evaluation::MapContents& contents) {
  io::PictureBounds bounds;
  for (const auto& submap : graph.submaps) {
    const auto cells = contents.submaps.find(submap.first);
    if (cells == contents.submaps.end()) continue;
    const Pose2 map_from_local = evaluation::MapFromLocal(submap.second);
    bounds.Add(map_from_local * cells->second.min_corner());
    bounds.Add(map_from_local * cells->second.max_corner());
  }
  return std::max(bounds.max_x - bounds.min_x, bounds.max_y - bounds.min_y);
}

Prepared Prepare(const ReportData& data, ImageStore* const store) {
  Prepared prepared;
  prepared.start = std::numeric_limits<io::TimeNs>::max();
  double side = 1.;
  for (const ReportRun& run : data.runs) {
    side = std::max(side, MapSide(run.graph, *data.contents));
  }
  const double cells = std::max(kFinestCells, side / kMaxPixels);
  for (size_t i = 0; i < data.runs.size(); ++i) {
    const ReportRun& run = data.runs[i];
    prepared.evidence.push_back(CollectEvidence(run, *data.contents));
    const auto map =
        evaluation::PaintContents(run.graph, *data.contents, cells);
    prepared.image_ids.emplace_back();
    if (map.ok()) {
      prepared.image_ids.back() = absl::StrCat("map", i);
      store->Add(prepared.image_ids.back(), *map);
      prepared.bounds.Add(*map);
    }
    for (const auto& node : run.graph.nodes) {
      prepared.bounds.Add(node.second.global_pose.translation());
      prepared.start = std::min(prepared.start, node.second.time);
    }
  }
  return prepared;
}

void AddNavigation(Markup* const page) {
  page->Open("nav", {{"aria-label", "Parts of this report"}});
  for (const auto& part : std::vector<std::pair<std::string, std::string>>{
           {"map", "Map"},
           {"loops", "Loops"},
           {"comparison", "Runs compared"},
           {"scores", "Scores"},
           {"path", "Along the path"},
           {"worst", "Worst loops"},
           {"timing", "Time and memory"},
           {"origin", "Origin"}}) {
    page->Element("a", {{"href", absl::StrCat("#", part.first)}}, part.second);
  }
  page->Close();
}

ordered_json ComparisonToJson(const evaluation::LoopComparison& comparison) {
  return {{"stored", comparison.first},
          {"run", comparison.second},
          {"common", comparison.common},
          {"common_same_pose", comparison.common_same_pose},
          {"fraction_of_stored", comparison.fraction_of_first},
          {"fraction_of_run", comparison.fraction_of_second},
          {"neighbour_instead", comparison.neighbour_instead},
          {"too_far", comparison.too_far},
          {"not_sampled", comparison.not_sampled},
          {"no_match", comparison.no_match},
          {"other_visit", comparison.other_visit}};
}

std::map<std::string, int> Reasons(
    const std::vector<proto::LoopDecision>& decisions) {
  std::map<std::string, int> reasons;
  for (const auto& decision : decisions) ++reasons[VerdictInWords(decision)];
  return reasons;
}

ordered_json RerunToJson(const evaluation::Rerun& rerun,
                         const bool with_times) {
  ordered_json json;
  json["nodes"] = rerun.nodes;
  json["placeholders"] = rerun.placeholders;
  json["guessed_insertions"] = rerun.guessed_insertions;
  json["searches"] = rerun.searches;
  json["matches"] = rerun.matches;
  json["followed_loops"] = rerun.followed_loops;
  if (!with_times) return json;
  json["wall_seconds"] = rerun.wall_seconds;
  json["cpu_seconds"] = rerun.cpu_seconds;
  json["loop_search_cpu_seconds"] = rerun.loop_cpu.total();
  json["search_cpu_seconds"] = rerun.loop_cpu.search;
  json["build_cpu_seconds"] = rerun.loop_cpu.build;
  json["verification_cpu_seconds"] = rerun.loop_cpu.verification;
  json["peak_memory_bytes"] = rerun.peak_memory_bytes;
  return json;
}

}  // namespace

absl::StatusOr<std::string> MakeReport(const ReportData& data) {
  if (data.runs.empty() || data.runs.front().graph.nodes.empty()) {
    return absl::InvalidArgumentError("a map without nodes has no report");
  }
  ImageStore store;
  const Prepared prepared = Prepare(data, &store);
  Markup page;
  page.Raw("<!DOCTYPE html>\n");
  page.Open("html", {{"lang", "en"}});
  AddHead(absl::StrCat(data.title, ": map report"), &page);
  page.Open("body");
  page.Raw(store.ToHtml());
  page.Open("main");
  page.Element("h1", {}, data.title);
  AddNavigation(&page);
  AddSummary(data, &page);
  AddMaps(data, prepared, &page);
  AddLoops(data, prepared, &page);
  AddComparison(data, &page);
  AddScores(data, prepared, &page);
  AddPath(data, prepared, &page);
  AddWorstLoops(data, prepared, &page);
  AddTiming(data, &page);
  AddOrigin(data, &page);
  page.Close();
  AddScans(data, prepared, &page);
  page.Open("script");
  page.Raw(Script());
  page.Raw(ViewerScript());
  page.Close();
  page.Close();
  page.Close();
  return page.str();
}

ordered_json RunsToJson(const ReportData& data) {
  ordered_json runs = ordered_json::array();
  for (const ReportRun& run : data.runs) {
    ordered_json json;
    json["name"] = run.name;
    json["loops"] = run.graph.num_loops();
    json["evaluation"] = evaluation::ToJson(run.evaluation);
    if (run.against_stored.has_value()) {
      json["against_stored"] = ComparisonToJson(*run.against_stored);
    }
    if (run.rerun.has_value()) {
      json["run"] = RerunToJson(*run.rerun, data.with_times);
      json["run"]["decisions"] = Reasons(run.decisions());
    }
    runs.push_back(json);
  }
  return runs;
}

std::string RunsToText(const ReportData& data) {
  std::string text;
  for (const ReportRun& run : data.runs) {
    if (!run.against_stored.has_value()) continue;
    const evaluation::LoopComparison& comparison = *run.against_stored;
    absl::StrAppendFormat(
        &text,
        "Run \"%s\"   %d loops, %d of the %d stored ones reproduced (%.1f %%; "
        "including other nodes of the visit %.1f %%)\n",
        run.name, comparison.second, comparison.common, comparison.first,
        100. * comparison.fraction_of_first,
        comparison.first == 0
            ? 100.
            : 100. * (comparison.common + comparison.neighbour_instead) /
                  comparison.first);
    const std::string missing = evaluation::ExplainMissing(comparison);
    if (!missing.empty()) absl::StrAppend(&text, "  missing: ", missing, "\n");
    absl::StrAppend(&text, evaluation::ToText(run.evaluation));
  }
  for (const std::string& assumption : data.assumptions) {
    absl::StrAppend(&text, "Assumed: ", assumption, "\n");
  }
  return text;
}

std::string LoopsToCsv(const ReportData& data) {
  std::string csv =
      "run,submap_trajectory_id,submap_index,node_trajectory_id,node_index,"
      "accepted,score,residual_translation,residual_rotation,cycles,"
      "open_share,truth,truth_translation,reason\n";
  for (const ReportRun& run : data.runs) {
    for (const LoopEvidence& loop : CollectEvidence(run, *data.contents)) {
      absl::StrAppendFormat(
          &csv, "%s,%d,%d,%d,%d,%d,%.4f,%.6f,%.6f,%d,%.4f,%s,%.6f,%s\n",
          run.name, loop.submap_id.trajectory_id, loop.submap_id.index,
          loop.node_id.trajectory_id, loop.node_id.index, loop.accepted ? 1 : 0,
          loop.score, loop.residual_translation, loop.residual_rotation,
          loop.partners, loop.open_share,
          loop.truth == evaluation::LoopVerdict::kCorrect ? "right"
          : loop.truth == evaluation::LoopVerdict::kWrong ? "wrong"
                                                          : "unknown",
          loop.truth_translation,
          loop.decision == nullptr ? "" : VerdictInWords(*loop.decision));
    }
  }
  return csv;
}

}  // namespace report
}  // namespace cartographer_ext
