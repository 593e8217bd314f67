// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::GraphId;
using evaluation::LoopVerdict;

// Lines in one figure; of more loops the good ones are thinned out.
constexpr size_t kMaxLines = 1500;

std::string StyleOf(const LoopEvidence& evidence) {
  if (!evidence.accepted) return "s6 bad";
  if (evidence.suspicious()) return "s2 bad";
  return evidence.truth == LoopVerdict::kCorrect ? "s3" : "s5";
}

void AddLoopFigure(const ReportRun& run, const std::string& image_id,
                   const std::vector<LoopEvidence>& evidence,
                   const Prepared& prepared, Markup* const page) {
  MapFigure figure(absl::StrCat("Loops, ", run.name), prepared.bounds);
  if (!image_id.empty()) figure.Image(image_id);
  figure.Path(NodePath(run.graph), "s7 thin");
  size_t good = 0;
  for (const LoopEvidence& loop : evidence) {
    if (loop.accepted && !loop.suspicious()) ++good;
  }
  const size_t step = 1 + good / kMaxLines;
  size_t position = 0, drawn_bad = 0;
  std::set<std::string> styles;
  // What matters is drawn last, over the rest.
  for (const bool bad : {false, true}) {
    for (const LoopEvidence& loop : evidence) {
      if ((!loop.accepted || loop.suspicious()) != bad) continue;
      if (!bad && position++ % step != 0) continue;
      if (bad && ++drawn_bad > kMaxLines) continue;
      const auto submap = run.graph.submaps.find(loop.submap_id);
      const auto node = run.graph.nodes.find(loop.node_id);
      if (submap == run.graph.submaps.end() || node == run.graph.nodes.end()) {
        continue;
      }
      const std::string style = StyleOf(loop);
      styles.insert(style);
      figure.Line(submap->second.global_pose.translation(),
                  node->second.global_pose.translation(), style,
                  Describe(loop));
    }
  }
  figure.Legend("path", "s7");
  if (styles.count("s3") > 0) figure.Legend("loop, right by truth", "s3");
  if (styles.count("s5") > 0) {
    figure.Legend("loop that the map agrees with", "s5");
  }
  if (styles.count("s2 bad") > 0) {
    figure.Legend(
        "loop wrong by truth, or off the map by more than half a metre",
        "s2 bad");
  }
  if (styles.count("s6 bad") > 0) {
    figure.Legend("rejected candidate", "s6 bad");
  }
  page->Open("figure");
  page->Raw(figure.ToHtml());
  page->Element("figcaption", {},
                absl::StrCat("Loops, ", run.name,
                             ": from the submap's origin to the node. Point at "
                             "a line for its evidence.",
                             step > 1 ? absl::StrCat(" Of the good ones every ",
                                                     step, "th is drawn.")
                                      : ""));
  page->Close();
}

std::set<std::pair<GraphId, GraphId>> LoopPairs(
    const evaluation::MapGraph& graph) {
  std::set<std::pair<GraphId, GraphId>> pairs;
  for (const auto& constraint : graph.constraints) {
    if (constraint.is_loop) {
      pairs.emplace(constraint.submap_id, constraint.node_id);
    }
  }
  return pairs;
}

// What became, in `other`, of the loops of `run` that it does not have.
void AddFates(const ReportRun& run, const ReportRun& other,
              Markup* const page) {
  std::map<std::pair<GraphId, GraphId>, const proto::LoopDecision*> decisions;
  for (const auto& decision : other.decisions()) {
    decisions[{{decision.submap_trajectory_id(), decision.submap_index()},
               {decision.node_trajectory_id(), decision.node_index()}}] =
        &decision;
  }
  if (decisions.empty()) return;
  const auto others = LoopPairs(other.graph);
  std::map<std::string, int> fates;
  for (const auto& pair : LoopPairs(run.graph)) {
    if (others.count(pair) > 0) {
      ++fates["accepted by both"];
      continue;
    }
    const auto decision = decisions.find(pair);
    ++fates[decision == decisions.end() ? "not a candidate there"
                                        : VerdictInWords(*decision->second)];
  }
  int only_other = 0;
  const auto own = LoopPairs(run.graph);
  for (const auto& pair : others) only_other += own.count(pair) == 0 ? 1 : 0;
  Table table({absl::StrCat("loops, ", run.name), "count"});
  for (const auto& fate : fates) {
    table.AddRow({fate.first, absl::StrCat(fate.second)});
  }
  table.AddRow({absl::StrCat("accepted by ", other.name, " only"),
                absl::StrCat(only_other)});
  page->Raw(table.ToHtml(absl::StrCat("What became of the loops \"", run.name,
                                      "\" in the run \"", other.name, "\"")));
}

}  // namespace

void AddLoops(const ReportData& data, const Prepared& prepared,
              Markup* const page) {
  AddHeading("loops", "Loops", page);
  for (size_t i = 0; i < data.runs.size(); ++i) {
    AddLoopFigure(data.runs[i], prepared.image_ids[i], prepared.evidence[i],
                  prepared, page);
  }
}

void AddComparison(const ReportData& data, Markup* const page) {
  if (data.runs.size() < 2) return;
  AddHeading("comparison", "Which loops the runs share", page);
  Table table({"run", "loops", "stored loops found again", "same place",
               "only in the run", "why others are missing"});
  for (const ReportRun& run : data.runs) {
    if (!run.against_stored.has_value()) continue;
    const evaluation::LoopComparison& comparison = *run.against_stored;
    table.AddRow(
        {run.name, absl::StrCat(comparison.second),
         absl::StrFormat("%d of %d (%.1f %%)", comparison.common,
                         comparison.first, 100. * comparison.fraction_of_first),
         absl::StrFormat("%d to 5 cm", comparison.common_same_pose),
         absl::StrCat(comparison.second - comparison.common),
         evaluation::ExplainMissing(comparison)});
  }
  page->Raw(table.ToHtml("Pairs of submap and node tied by a loop"));
  for (const ReportRun& run : data.runs) {
    if (run.decisions().empty()) continue;
    std::map<std::string, int> reasons;
    for (const auto& decision : run.decisions()) {
      ++reasons[VerdictInWords(decision)];
    }
    Table verdicts({absl::StrCat("candidates, ", run.name), "count"});
    for (const auto& reason : reasons) {
      verdicts.AddRow({reason.first, absl::StrCat(reason.second)});
    }
    page->Raw(verdicts.ToHtml("Verdicts and their reasons"));
    for (const ReportRun& other : data.runs) {
      if (&other != &run) AddFates(other, run, page);
    }
  }
}

}  // namespace report
}  // namespace cartographer_ext
