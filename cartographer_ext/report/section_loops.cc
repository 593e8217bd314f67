// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::GraphId;
using evaluation::LoopPair;
using evaluation::LoopVerdict;

// Lines in one figure; of more loops the good ones are thinned out.
constexpr size_t kMaxLines = 1500;

// The scans that a click shows: centimetres, limit of the bytes in total.
constexpr size_t kMaxScanBytes = 1500000;
constexpr size_t kPointBytes = 10;
constexpr size_t kMaxScanPoints = 160;
constexpr size_t kMinScanPoints = 30;
constexpr double kMaxScanRange = 1000.;  // metres

std::string StyleOf(const LoopEvidence& evidence) {
  if (!evidence.accepted) return "s6 bad";
  if (evidence.suspicious()) return "s2 bad";
  return evidence.truth == LoopVerdict::kCorrect ? "s3" : "s5";
}

std::string PoseText(const Pose2& pose) {
  return absl::StrCat(Number(pose.x, 3), " ", Number(pose.y, 3), " ",
                      Number(pose.theta, 4));
}

// What a click on the loop shows: its ids, its node's scan, and where the loop
// and the map put that.
Attributes LoopAttributes(const LoopEvidence& loop,
                          const evaluation::GraphSubmap& submap,
                          const evaluation::GraphNode& node,
                          const io::TimeNs start) {
  return {{"data-id", evaluation::LoopName(loop.submap_id, loop.node_id)},
          {"data-pose",
           absl::StrFormat("%.3f:%.3f:%.4f", loop.relative_pose.x,
                           loop.relative_pose.y, loop.relative_pose.theta)},
          {"data-t", Number(io::ToSeconds(node.time - start), 1)},
          {"data-loop", PoseText(submap.global_pose * loop.relative_pose)},
          {"data-map", PoseText(node.global_pose)}};
}

// Pieces that contradict the map, and nodes with a degenerate scan.
void AddTrouble(const ReportData& data, const ReportRun& run,
                MapFigure* const figure) {
  if (run.evaluation.consistency.has_value() &&
      !run.evaluation.consistency->places.empty()) {
    for (const auto& piece : run.evaluation.consistency->places) {
      std::vector<Eigen::Vector2d> path;
      for (auto node = run.graph.nodes.find(piece.first_node);
           node != run.graph.nodes.end() && !(piece.last_node < node->first);
           ++node) {
        path.push_back(node->second.global_pose.translation());
      }
      figure->Path(path, "s4");
    }
    figure->Legend("scans that contradict the map", "s4");
  }
  const evaluation::Trajectory trajectory = run.graph.GlobalTrajectory();
  std::vector<Eigen::Vector2d> degenerate;
  for (const DegeneracySample& sample : data.degeneracy) {
    if (!sample.degenerate) continue;
    const auto pose = trajectory.Lookup(sample.time, 0);
    if (!pose.has_value()) continue;
    degenerate.emplace_back(pose->translation().x(), pose->translation().y());
  }
  if (degenerate.empty()) return;
  figure->Dots(degenerate, "s6");
  figure->Legend("degenerate scans", "s6");
}

void AddLoopFigure(const ReportData& data, const ReportRun& run,
                   const std::string& image_id,
                   const std::vector<LoopEvidence>& evidence,
                   const Prepared& prepared, Markup* const page) {
  MapFigure figure(absl::StrCat("Loops, ", run.name), prepared.bounds);
  if (!image_id.empty()) figure.Image(image_id);
  figure.TimedPath(NodePath(run.graph), NodeSeconds(run.graph, prepared.start),
                   "s7 thin");
  AddTrouble(data, run, &figure);
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
      figure.Line(
          submap->second.global_pose.translation(),
          node->second.global_pose.translation(), style, Describe(loop),
          LoopAttributes(loop, submap->second, node->second, prepared.start));
    }
  }
  figure.Legend("path", "s7");
  if (styles.count("s3") > 0)
    figure.Legend("loop, right by ground truth", "s3");
  if (styles.count("s5") > 0) {
    figure.Legend("loop consistent with the map", "s5");
  }
  if (styles.count("s2 bad") > 0) {
    figure.Legend(
        "loop wrong by ground truth, or more than half a metre off the map",
        "s2 bad");
  }
  if (styles.count("s6 bad") > 0) {
    figure.Legend("rejected candidate", "s6 bad");
  }
  page->Open("figure");
  page->Raw(figure.ToHtml());
  page->Element(
      "figcaption", {},
      absl::StrCat("Loops, ", run.name,
                   ": from the submap's origin to the node. Hover over a line "
                   "for its evidence; click it to see its scan at the pose of "
                   "the loop (blue) and at the pose in the map (orange).",
                   step > 1 ? absl::StrCat(" Of the good ones every ", step,
                                           "th is drawn.")
                            : ""));
  page->Close();
}

std::set<LoopPair> LoopPairs(const evaluation::MapGraph& graph) {
  std::set<LoopPair> pairs;
  for (const auto& constraint : graph.constraints) {
    if (constraint.is_loop) {
      pairs.emplace(constraint.submap_id, constraint.node_id);
    }
  }
  return pairs;
}

// What became, in `other`, of the loops of `run` that it does not have.
void AddOutcomes(const ReportRun& run, const ReportRun& other,
                 Markup* const page) {
  std::map<LoopPair, const proto::LoopDecision*> decisions;
  for (const auto& decision : other.decisions()) {
    decisions[PairOf(decision)] = &decision;
  }
  if (decisions.empty()) return;
  const auto others = LoopPairs(other.graph);
  std::map<std::string, int> outcomes;
  for (const auto& pair : LoopPairs(run.graph)) {
    if (others.count(pair) > 0) {
      ++outcomes["accepted by both"];
      continue;
    }
    const auto decision = decisions.find(pair);
    ++outcomes[decision == decisions.end() ? "not a candidate there"
                                           : VerdictInWords(*decision->second)];
  }
  int only_other = 0;
  const auto own = LoopPairs(run.graph);
  for (const auto& pair : others) only_other += own.count(pair) == 0 ? 1 : 0;
  Table table({absl::StrCat("loops, ", run.name), "count"});
  for (const auto& outcome : outcomes) {
    table.AddRow({outcome.first, absl::StrCat(outcome.second)});
  }
  table.AddRow({absl::StrCat("accepted by ", other.name, " only"),
                absl::StrCat(only_other)});
  page->Raw(table.ToHtml(absl::StrCat("Outcome of the loops \"", run.name,
                                      "\" in the run \"", other.name, "\"")));
}

}  // namespace

void AddLoops(const ReportData& data, const Prepared& prepared,
              Markup* const page) {
  AddHeading("loops", "Loops", page);
  for (size_t i = 0; i < data.runs.size(); ++i) {
    AddLoopFigure(data, data.runs[i], prepared.image_ids[i],
                  prepared.evidence[i], prepared, page);
  }
}

void AddScans(const ReportData& data, const Prepared& prepared,
              Markup* const page) {
  const std::vector<GraphId> places = NodesOfPlaces(data);
  const std::set<GraphId> always(places.begin(), places.end());
  std::set<GraphId> nodes = always;
  for (const auto& evidence : prepared.evidence) {
    for (const LoopEvidence& loop : evidence) nodes.insert(loop.node_id);
  }
  if (nodes.empty()) return;
  const size_t max_points = std::min(
      kMaxScanPoints,
      std::max(kMinScanPoints, kMaxScanBytes / kPointBytes / nodes.size()));
  // Of more nodes than the room is for, evenly as many as there is room for.
  const size_t room = kMaxScanBytes / kPointBytes / kMinScanPoints;
  const size_t step = 1 + nodes.size() / room;
  page->Open("script", {{"type", "application/json"}, {"id", "scans"}});
  std::string json = "{";
  size_t position = 0;
  for (const GraphId& id : nodes) {
    const auto scan = data.contents->scans.find(id);
    if (scan == data.contents->scans.end() ||
        (position++ % step != 0 && always.count(id) == 0)) {
      continue;
    }
    absl::StrAppend(&json, json.size() > 1 ? ",\n" : "", "\"", id.trajectory_id,
                    ":", id.index, "\":[");
    const size_t every = 1 + scan->second.size() / max_points;
    for (size_t i = 0; i < scan->second.size(); i += every) {
      const Eigen::Vector2d& point = scan->second[i];
      if (!point.allFinite() || point.norm() > kMaxScanRange) continue;
      absl::StrAppend(&json, json.back() == '[' ? "" : ",",
                      std::lround(100. * point.x()), ",",
                      std::lround(100. * point.y()));
    }
    json += "]";
  }
  page->Raw(json + "}");
  page->Close();
}

void AddComparison(const ReportData& data, Markup* const page) {
  if (data.runs.size() < 2) return;
  AddHeading("comparison", "Which loops the runs share", page);
  Table table({"run", "loops", "stored loops reproduced", "same pose",
               "only in the run", "why others are missing"});
  for (const ReportRun& run : data.runs) {
    if (!run.against_stored.has_value()) continue;
    const evaluation::LoopComparison& comparison = *run.against_stored;
    table.AddRow(
        {run.name, absl::StrCat(comparison.second),
         absl::StrFormat("%d of %d (%.1f %%)", comparison.common,
                         comparison.first, 100. * comparison.fraction_of_first),
         absl::StrFormat("%d within 5 cm", comparison.common_same_pose),
         absl::StrCat(comparison.second - comparison.common),
         evaluation::ExplainMissing(comparison)});
  }
  page->Raw(table.ToHtml("Pairs of submap and node with a loop"));
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
      if (&other != &run) AddOutcomes(other, run, page);
    }
  }
}

}  // namespace report
}  // namespace cartographer_ext
