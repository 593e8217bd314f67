// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/repair/repair_output.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/picture.h"
#include "cartographer_ext/map/comparison/map_comparison.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/report/comparison_report.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace repair {
namespace {

using nlohmann::ordered_json;
using report::Markup;

constexpr double kFinestCells = 0.05;  // metres
constexpr double kMaxPixels = 1600.;

ordered_json QualityJson(const MapQuality& quality) {
  return {{"verdict", quality.verdict},
          {"severe_share", quality.severe_share},
          {"loose_share", quality.loose_share},
          {"contradicted_rays", quality.contradicted_rays},
          {"open_cycles", quality.open_cycles},
          {"loop_residual", quality.loop_residual},
          {"mean_map_entropy", quality.entropy},
          {"agreeing_nodes", quality.num_agreeing()},
          {"contradicted_nodes", quality.num_contradicted()}};
}

ordered_json VersionJson(const MapVersion& version) {
  ordered_json json = QualityJson(version.quality);
  json["loops"] = version.graph.num_loops();
  json["reasons"] = version.consistency.reasons;
  return json;
}

// Metres a cell so that neither map becomes too large a picture.
double CellSize(const MapRepair& repair) {
  io::PictureBounds bounds;
  for (const MapVersion* const version : {&repair.before, &repair.after}) {
    for (const auto& node : version->graph.nodes) {
      bounds.Add(node.second.global_pose.translation());
    }
  }
  return std::max(kFinestCells, std::max(bounds.max_x - bounds.min_x,
                                         bounds.max_y - bounds.min_y) /
                                    kMaxPixels);
}

void AddPicture(const std::string& name, const std::string& id,
                const io::OccupancyMap& map, const MapVersion& version,
                Markup* const page) {
  report::ImageStore store;
  store.Add(id, map);
  page->Raw(store.ToHtml());
  io::PictureBounds bounds;
  bounds.Add(map);
  report::MapFigure figure(absl::StrCat("Map, ", name), bounds);
  figure.Image(id);
  figure.Path(report::NodePath(version.graph), "s1 thin");
  page->Open("figure");
  page->Raw(figure.ToHtml());
  page->Element("figcaption", {}, name);
  page->Close();
}

void AddSteps(const MapRepair& repair, Markup* const page) {
  page->Element("h2", {}, "Steps");
  report::Table table({"step", "kept", "loops", "why"});
  for (const RepairStep& step : repair.steps) {
    table.AddRow({step.name, step.kept ? "kept" : "not kept",
                  step.has_quality ? absl::StrCat(step.loops) : "",
                  step.reason});
  }
  if (table.empty()) {
    page->Element("p", {}, "None was needed.");
  } else {
    page->Raw(
        table.ToHtml("Each step is kept only if its map is better than the "
                     "best one so far"));
  }
}

}  // namespace

ordered_json ToJson(const MapRepair& repair) {
  ordered_json json;
  json["conclusion"] = repair.conclusion;
  json["before"] = VersionJson(repair.before);
  json["after"] = VersionJson(repair.after);
  json["steps"] = ordered_json::array();
  for (const RepairStep& step : repair.steps) {
    ordered_json entry;
    entry["name"] = step.name;
    entry["kept"] = step.kept;
    entry["reason"] = step.reason;
    if (step.has_quality) {
      entry["loops"] = step.loops;
      entry.update(QualityJson(step.quality));
    }
    json["steps"].push_back(entry);
  }
  json["local_slam"] = ordered_json::array();
  for (const LocalFault& fault : repair.faults) {
    json["local_slam"].push_back({{"node", evaluation::ToString(fault.node_id)},
                                  {"seconds", fault.seconds},
                                  {"metres", fault.metres},
                                  {"degrees", RadToDeg(fault.radians)}});
  }
  json["advice"] = repair.advice;
  return json;
}

std::string ToText(const MapRepair& repair) {
  std::string text =
      absl::StrCat("Before   ", ToText(repair.before.quality), "\n");
  for (const RepairStep& step : repair.steps) {
    absl::StrAppend(&text, step.kept ? "kept     " : "dropped  ", step.name,
                    ": ", step.reason, "\n");
  }
  absl::StrAppend(&text, "After    ", ToText(repair.after.quality), "\n");
  for (const LocalFault& fault : repair.faults) {
    absl::StrAppend(&text, "  ", ToText(fault), "\n");
  }
  absl::StrAppend(&text, repair.conclusion, "\n");
  for (const std::string& advice : repair.advice) {
    absl::StrAppend(&text, "  - ", advice, "\n");
  }
  return text;
}

absl::StatusOr<std::string> MakeRepairReport(const MapRepair& repair,
                                             const std::string& title,
                                             const std::string& command_line) {
  const double cells = CellSize(repair);
  const auto before =
      evaluation::PaintPbstreamMap(*repair.before.pbstream, cells);
  if (!before.ok()) return before.status();
  const auto after =
      evaluation::PaintPbstreamMap(*repair.after.pbstream, cells);
  if (!after.ok()) return after.status();
  Markup page;
  report::OpenPage(absl::StrCat(title, ": repair"), &page);
  page.Open("p");
  page.Element("b", {}, repair.conclusion);
  page.Close();
  report::AddVerdictBox("before", repair.before.consistency, &page);
  if (repair.changed()) {
    report::AddVerdictBox("after", repair.after.consistency, &page);
  }
  page.Element("h2", {}, "What to do");
  page.Open("ul");
  for (const std::string& advice : repair.advice) {
    page.Element("li", {}, advice);
  }
  for (const LocalFault& fault : repair.faults) {
    page.Element("li", {}, absl::StrCat("Look at: ", ToText(fault)));
  }
  page.Close();
  AddSteps(repair, &page);
  page.Element("h2", {}, "Before and after");
  page.Open("div", {{"class", "pair"}});
  AddPicture("before", "map-before", *before, repair.before, &page);
  AddPicture("after", "map-after", *after, repair.after, &page);
  page.Close();
  if (repair.changed()) {
    const auto comparison = evaluation::CompareMaps(
        {&repair.before.graph, &*before}, {&repair.after.graph, &*after}, {});
    if (comparison.ok()) {
      report::AddComparisonFigures(
          {"before", &*before, &repair.before.graph,
           &repair.before.consistency},
          {"after", &*after, &repair.after.graph, &repair.after.consistency},
          *comparison, &page);
    }
  }
  page.Element("p", {{"class", "soft"}}, command_line);
  report::ClosePage(&page);
  return page.str();
}

}  // namespace repair
}  // namespace cartographer_ext
