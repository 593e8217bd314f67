// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::ConflictPiece;
using evaluation::GraphId;
using evaluation::ToString;

std::vector<Eigen::Vector2d> PathOfNodes(const evaluation::MapGraph& graph,
                                         const GraphId& first,
                                         const GraphId& last) {
  std::vector<Eigen::Vector2d> path;
  for (auto it = graph.nodes.find(first); it != graph.nodes.end(); ++it) {
    if (last < it->first) break;
    path.push_back(it->second.global_pose.translation());
  }
  return path;
}

// The stored map with rings round the places that speak against it.
void AddPlaces(const ReportData& data, const Prepared& prepared,
               Markup* const page) {
  const ReportRun& stored = data.runs.front();
  MapFigure figure("Map with the places that contradict it", prepared.bounds);
  if (!prepared.image_ids[0].empty()) figure.Image(prepared.image_ids[0]);
  figure.Path(NodePath(stored.graph), "s1");
  figure.Legend("path of the robot", "s1");
  Table table({"place", "x", "y", "nodes", "after the start",
               "rays contradicted", "contradicts"});
  if (stored.evaluation.consistency.has_value()) {
    const auto& consistency = *stored.evaluation.consistency;
    if (!consistency.severe.empty()) {
      figure.Legend("nodes whose scans contradict the map", "s2");
    }
    for (const auto& piece : consistency.severe) {
      figure.Path(PathOfNodes(stored.graph, piece.first_node, piece.last_node),
                  "s2");
    }
    int number = 0;
    for (const ConflictPiece& piece : consistency.severe) {
      ++number;
      std::string submaps;
      for (const GraphId& id : piece.submaps) {
        absl::StrAppend(&submaps, submaps.empty() ? "" : " ", ToString(id));
      }
      const std::string seconds = absl::StrFormat(
          "%.1f to %.1f s", io::ToSeconds(piece.begin - prepared.start),
          io::ToSeconds(piece.end - prepared.start));
      figure.Ring(
          piece.center, 0.5 * piece.metres + 1., absl::StrCat(number),
          absl::StrFormat("place %d: nodes %s to %s\n%s\n%.0f %% of the rays "
                          "contradict submaps %s",
                          number, ToString(piece.first_node),
                          ToString(piece.last_node), seconds,
                          100. * piece.fraction, submaps));
      table.AddRow({absl::StrCat(number),
                    absl::StrFormat("%.1f m", piece.center.x()),
                    absl::StrFormat("%.1f m", piece.center.y()),
                    absl::StrCat(ToString(piece.first_node), " to ",
                                 ToString(piece.last_node)),
                    seconds, absl::StrFormat("%.0f %%", 100. * piece.fraction),
                    absl::StrCat("submaps ", submaps)});
    }
    char letter = 'A';
    for (const auto& step : consistency.wrong_turns) {
      if (letter > 'F') break;
      const auto& node = stored.graph.nodes.at(step.node_id);
      const std::string words = absl::StrFormat(
          "local SLAM and odometry differ by %.0f deg before node %s, %.1f s "
          "after the start",
          RadToDeg(step.odometry_rotation), ToString(step.node_id),
          io::ToSeconds(step.time - prepared.start));
      figure.Ring(node.global_pose.translation(), 0.8, std::string(1, letter),
                  words);
      table.AddRow(
          {std::string(1, letter),
           absl::StrFormat("%.1f m", node.global_pose.x),
           absl::StrFormat("%.1f m", node.global_pose.y),
           ToString(step.node_id),
           absl::StrFormat("%.1f s", io::ToSeconds(step.time - prepared.start)),
           "",
           absl::StrFormat("odometry, by %.0f deg",
                           RadToDeg(step.odometry_rotation))});
      ++letter;
    }
  }
  page->Open("figure");
  page->Raw(figure.ToHtml());
  page->Element(
      "figcaption", {},
      "The map as stored. Numbers: path pieces whose scans are in free space "
      "or behind walls mapped by another visit. Letters: places where the "
      "rotation of local SLAM differs from that of the wheels.");
  page->Close();
  if (!table.empty()) page->Raw(table.ToHtml("Places that contradict the map"));
}

std::string PlainMap(const ReportData& data, const Prepared& prepared,
                     const size_t index) {
  MapFigure figure(absl::StrCat("Map, ", data.runs[index].name),
                   prepared.bounds);
  if (!prepared.image_ids[index].empty()) {
    figure.Image(prepared.image_ids[index]);
  }
  figure.Path(NodePath(data.runs[index].graph),
              absl::StrCat(data.runs[index].style, " thin"));
  return figure.ToHtml();
}

// The pictures over each other with a line to move, and side by side on paper.
void AddBeforeAndAfter(const ReportData& data, const Prepared& prepared,
                       const size_t after, Markup* const page) {
  const std::string id = absl::StrCat("compare", after);
  page->Element("h3", {},
                absl::StrCat("Before and after: ", data.runs[0].name, ", ",
                             data.runs[after].name));
  page->Open("figure", {{"class", "screen-only"}});
  page->Open("label", {{"class", "slider"}});
  page->Element("span", {}, data.runs[0].name);
  page->Empty("input", {{"type", "range"},
                        {"min", "0"},
                        {"max", "100"},
                        {"value", "50"},
                        {"data-target", id},
                        {"aria-label", "Share of the map as stored"}});
  page->Element("span", {}, data.runs[after].name);
  page->Close();
  page->Open("div", {{"class", "compare"}, {"id", id}});
  page->Raw(PlainMap(data, prepared, after));
  page->Open("div", {{"class", "top"}});
  page->Raw(PlainMap(data, prepared, 0));
  page->Close();
  page->Element("div", {{"class", "rule"}}, "");
  page->Close();
  page->Element("figcaption", {},
                absl::StrCat("Left of the line the map ", data.runs[0].name,
                             ", right of it ", data.runs[after].name, "."));
  page->Close();
  page->Open("div", {{"class", "pair print-only"}});
  for (const size_t index : {size_t{0}, after}) {
    page->Open("figure");
    page->Raw(PlainMap(data, prepared, index));
    page->Element("figcaption", {}, data.runs[index].name);
    page->Close();
  }
  page->Close();
}

}  // namespace

std::vector<Eigen::Vector2d> NodePath(const evaluation::MapGraph& graph) {
  std::vector<Eigen::Vector2d> path;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int trajectory_id = 0;
  for (const auto& entry : graph.nodes) {
    if (!path.empty() && entry.first.trajectory_id != trajectory_id) {
      path.emplace_back(nan, nan);
    }
    trajectory_id = entry.first.trajectory_id;
    path.push_back(entry.second.global_pose.translation());
  }
  return path;
}

void AddMaps(const ReportData& data, const Prepared& prepared,
             Markup* const page) {
  AddHeading("map", "The map", page);
  AddPlaces(data, prepared, page);
  if (data.runs.size() < 2) return;
  MapFigure paths("Trajectories of all runs over the map", prepared.bounds);
  if (!prepared.image_ids[0].empty()) paths.Image(prepared.image_ids[0]);
  for (const ReportRun& run : data.runs) {
    paths.Path(NodePath(run.graph), run.style);
    paths.Legend(run.name, run.style);
  }
  page->Open("figure");
  page->Raw(paths.ToHtml());
  page->Element("figcaption", {},
                "Trajectories of the nodes, over the map as stored. All start "
                "at the same pose.");
  page->Close();
  for (size_t i = 1; i < data.runs.size(); ++i) {
    AddBeforeAndAfter(data, prepared, i, page);
  }
}

}  // namespace report
}  // namespace cartographer_ext
