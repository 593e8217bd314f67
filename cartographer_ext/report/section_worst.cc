// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/map/map_painter.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::GraphId;
using evaluation::LoopVerdict;
using evaluation::ToString;

constexpr size_t kPictures = 6;
constexpr size_t kRows = 25;
constexpr size_t kMaxScanPoints = 400;
// What a picture shows around the scan, metres.
constexpr double kSurroundings = 2.;
constexpr double kFarthest = 15.;
// Of the sides of a picture, the shorter to the longer at least.
constexpr double kAspect = 0.75;

std::vector<const LoopEvidence*> Worst(
    const std::vector<LoopEvidence>& evidence) {
  std::vector<const LoopEvidence*> worst;
  for (const LoopEvidence& loop : evidence) {
    if (loop.in_graph) worst.push_back(&loop);
  }
  std::stable_sort(worst.begin(), worst.end(),
                   [](const LoopEvidence* a, const LoopEvidence* b) {
                     if (a->suspicious() != b->suspicious()) {
                       return a->suspicious();
                     }
                     return a->badness() > b->badness();
                   });
  return worst;
}

std::vector<Eigen::Vector2d> Placed(const std::vector<Eigen::Vector2d>& scan,
                                    const Pose2& pose) {
  std::vector<Eigen::Vector2d> result;
  const size_t step = 1 + scan.size() / kMaxScanPoints;
  for (size_t i = 0; i < scan.size(); i += step) {
    result.push_back(pose * scan[i]);
  }
  return result;
}

// Pictures of submaps, in their own frames, each once.
class SubmapPictures {
 public:
  SubmapPictures(const evaluation::MapGraph& graph,
                 const evaluation::MapContents& contents)
      : graph_(graph), contents_(contents) {}

  // The id of the picture; empty where there is none.
  std::string Get(const GraphId& id) {
    const std::string name =
        absl::StrCat("submap-", id.trajectory_id, "-", id.index);
    const auto submap = graph_.submaps.find(id);
    const auto cells = contents_.submaps.find(id);
    if (submap == graph_.submaps.end() || cells == contents_.submaps.end()) {
      return "";
    }
    if (!known_.insert(name).second) return name;
    const auto map = evaluation::PaintMap(
        {{&cells->second.grid(), submap->second.local_pose.Inverse()}},
        kResolution);
    if (!map.ok()) return "";
    store_.Add(name, *map);
    return name;
  }

  std::string ToHtml() const { return store_.ToHtml(); }

 private:
  static constexpr double kResolution = 0.05;

  const evaluation::MapGraph& graph_;
  const evaluation::MapContents& contents_;
  std::set<std::string> known_;
  ImageStore store_;
};

// Shows more of the surroundings instead of a tall or flat picture.
void MakeCompact(io::PictureBounds* const bounds) {
  const double width = bounds->max_x - bounds->min_x;
  const double height = bounds->max_y - bounds->min_y;
  const double more_x = 0.5 * std::max(0., kAspect * height - width);
  const double more_y = 0.5 * std::max(0., kAspect * width - height);
  bounds->min_x -= more_x;
  bounds->max_x += more_x;
  bounds->min_y -= more_y;
  bounds->max_y += more_y;
}

std::string DrawLoop(const ReportRun& run, const ReportData& data,
                     const LoopEvidence& loop, const std::string& image_id) {
  const auto scan = data.contents->scans.find(loop.node_id);
  const auto submap = run.graph.submaps.find(loop.submap_id);
  const auto node = run.graph.nodes.find(loop.node_id);
  if (scan == data.contents->scans.end() || submap == run.graph.submaps.end() ||
      node == run.graph.nodes.end()) {
    return "";
  }
  const Pose2 by_map =
      Between(submap->second.global_pose, node->second.global_pose);
  const auto at_loop = Placed(scan->second, loop.relative_pose);
  const auto at_map = Placed(scan->second, by_map);
  io::PictureBounds bounds;
  const Eigen::Vector2d center = loop.relative_pose.translation();
  for (const auto* points : {&at_loop, &at_map}) {
    for (const Eigen::Vector2d& point : *points) {
      if ((point - center).norm() < kFarthest) bounds.Add(point);
    }
  }
  bounds.Add(center);
  bounds.Add(by_map.translation());
  bounds.min_x -= kSurroundings;
  bounds.min_y -= kSurroundings;
  bounds.max_x += kSurroundings;
  bounds.max_y += kSurroundings;
  MakeCompact(&bounds);
  MapFigure figure("Scan on the submap", bounds);
  if (!image_id.empty()) figure.Image(image_id);
  figure.Dots(at_map, "s2");
  figure.Dots(at_loop, "s1");
  figure.Line(by_map.translation(), center, "s4", Describe(loop));
  return figure.ToHtml();
}

std::string TruthInWords(const LoopEvidence& loop) {
  switch (loop.truth) {
    case LoopVerdict::kCorrect:
      return absl::StrFormat("right (%.2f m)", loop.truth_translation);
    case LoopVerdict::kWrong:
      return absl::StrFormat("wrong (%.2f m)", loop.truth_translation);
    case LoopVerdict::kUnknown:
      break;
  }
  return "not known";
}

}  // namespace

void AddWorstLoops(const ReportData& data, const Prepared& prepared,
                   Markup* const page) {
  const ReportRun& run = data.runs.front();
  const auto worst = Worst(prepared.evidence.front());
  if (worst.empty()) return;
  AddHeading("worst", "The worst loops", page);
  page->Element("p", {},
                "Each scan on the submap of its loop: blue at the pose of the "
                "loop, orange at the pose in the optimised map. One loop is "
                "shown per pair of submap and visit.");
  SubmapPictures pictures(run.graph, *data.contents);
  Markup figures;
  std::set<std::pair<GraphId, int>> shown;
  size_t count = 0;
  for (const LoopEvidence* loop : worst) {
    if (count == kPictures) break;
    // Nodes of one visit give the same picture.
    constexpr int kVisit = 40;
    if (!shown.insert({loop->submap_id, loop->node_id.index / kVisit}).second) {
      continue;
    }
    const std::string drawing =
        DrawLoop(run, data, *loop, pictures.Get(loop->submap_id));
    if (drawing.empty()) continue;
    ++count;
    figures.Open("figure");
    figures.Raw(drawing);
    figures.Element(
        "figcaption", {},
        absl::StrFormat("submap %s, node %s: score %.2f, %.2f m from the map",
                        ToString(loop->submap_id), ToString(loop->node_id),
                        loop->score, loop->residual_translation));
    figures.Close();
  }
  page->Raw(pictures.ToHtml());
  page->Open("div", {{"class", "grid3"}});
  if (!figures.empty()) page->Raw(figures.str());
  page->Close();

  Table table({"submap", "node", "after the start", "score", "off the map",
               "turned", "open cycles", "truth"});
  for (size_t i = 0; i < std::min(kRows, worst.size()); ++i) {
    const LoopEvidence& loop = *worst[i];
    const auto node = run.graph.nodes.find(loop.node_id);
    table.AddRow(
        {ToString(loop.submap_id), ToString(loop.node_id),
         node == run.graph.nodes.end()
             ? ""
             : absl::StrFormat(
                   "%.1f s", io::ToSeconds(node->second.time - prepared.start)),
         loop.score < 0. ? "" : absl::StrFormat("%.3f", loop.score),
         absl::StrFormat("%.3f m", loop.residual_translation),
         absl::StrFormat("%.2f deg", RadToDeg(loop.residual_rotation)),
         loop.partners == 0
             ? "none near"
             : absl::StrFormat("%.0f %% of %d", 100. * loop.open_share,
                               loop.partners),
         TruthInWords(loop)});
  }
  page->Raw(table.ToHtml(absl::StrCat("The ", std::min(kRows, worst.size()),
                                      " worst of ", worst.size(),
                                      " loops of the map ", run.name)));
}

}  // namespace report
}  // namespace cartographer_ext
