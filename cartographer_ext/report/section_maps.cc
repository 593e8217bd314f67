// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/types/optional.h"
#include "cartographer_ext/report/map_figure.h"
#include "cartographer_ext/report/sections.h"

namespace cartographer_ext {
namespace report {
namespace {

using evaluation::GraphId;
using evaluation::MapGraph;
using evaluation::MotionStep;
using evaluation::PathPiece;
using evaluation::SelfConsistency;
using evaluation::ToString;

// Wrong turns with a letter of their own.
constexpr size_t kMaxLetters = 6;

// Two nodes whose scans tell what is wrong at a place.
struct ScanPair {
  GraphId first, second;
  std::string words;  // which is which
};

std::vector<Eigen::Vector2d> PathOfNodes(const MapGraph& graph,
                                         const GraphId& first,
                                         const GraphId& last) {
  std::vector<Eigen::Vector2d> path;
  for (auto it = graph.nodes.find(first); it != graph.nodes.end(); ++it) {
    if (last < it->first) break;
    path.push_back(it->second.global_pose.translation());
  }
  return path;
}

using InsertedNodes = std::map<GraphId, std::vector<GraphId>>;  // by submap

// A node, and the submap of another time that it disagrees with.
struct Disagreement {
  GraphId node_id, submap_id;
  double amount = -1.;
};

// The worst node of the piece.
Disagreement WorstOf(const SelfConsistency& consistency,
                     const PathPiece& piece) {
  Disagreement worst;
  const auto consider = [&](const GraphId& node_id, const GraphId& submap_id,
                            const double amount) {
    if (node_id < piece.first_node || piece.last_node < node_id) return;
    if (amount > worst.amount) worst = {node_id, submap_id, amount};
  };
  if (piece.is_displaced()) {
    for (const auto& node : consistency.displacements.nodes) {
      consider(node.node_id, node.submap_id, node.displacement);
    }
  } else {
    for (const auto& node : consistency.contradictions.nodes) {
      consider(node.node_id, node.worst_submap_id, node.worst_fraction);
    }
  }
  return worst;
}

// The worst node of the piece, and of the submap that it disagrees with most
// the nearest node.
absl::optional<ScanPair> PairOf(const MapGraph& graph,
                                const InsertedNodes& inserted,
                                const SelfConsistency& consistency,
                                const PathPiece& piece) {
  const Disagreement worst = WorstOf(consistency, piece);
  if (worst.amount < 0. || graph.nodes.count(worst.node_id) == 0) {
    return absl::nullopt;
  }
  const Eigen::Vector2d place =
      graph.nodes.at(worst.node_id).global_pose.translation();
  absl::optional<GraphId> nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto others = inserted.find(worst.submap_id);
  if (others == inserted.end()) return absl::nullopt;
  for (const GraphId& id : others->second) {
    const auto node = graph.nodes.find(id);
    if (node == graph.nodes.end()) continue;
    const double distance =
        (node->second.global_pose.translation() - place).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = id;
  }
  if (!nearest.has_value()) return absl::nullopt;
  return ScanPair{
      worst.node_id, *nearest,
      absl::StrCat("Scans in the map: orange of node ", ToString(worst.node_id),
                   ", blue of node ", ToString(*nearest),
                   " of the contradicted submap ", ToString(worst.submap_id),
                   ".")};
}

absl::optional<ScanPair> PairOf(const MapGraph& graph, const MotionStep& step) {
  const auto node = graph.nodes.find(step.node_id);
  if (node == graph.nodes.end() || node == graph.nodes.begin()) {
    return absl::nullopt;
  }
  const GraphId before = std::prev(node)->first;
  if (before.trajectory_id != step.node_id.trajectory_id) return absl::nullopt;
  return ScanPair{step.node_id, before,
                  absl::StrCat("Scans in the map: blue before the turn, node ",
                               ToString(before), ", orange after it, node ",
                               ToString(step.node_id), ".")};
}

// Of the severe pieces, then of the turns that have a letter.
std::vector<absl::optional<ScanPair>> PairsOf(
    const MapGraph& graph, const SelfConsistency& consistency) {
  std::vector<absl::optional<ScanPair>> pairs;
  const InsertedNodes inserted = graph.InsertedNodes();
  for (const PathPiece& piece : consistency.places) {
    pairs.push_back(PairOf(graph, inserted, consistency, piece));
  }
  const size_t count = std::min(kMaxLetters, consistency.wrong_turns.size());
  for (size_t i = 0; i != count; ++i) {
    pairs.push_back(PairOf(graph, consistency.wrong_turns[i]));
  }
  return pairs;
}

std::string ScanText(const MapGraph& graph, const GraphId& id) {
  const Pose2& pose = graph.nodes.at(id).global_pose;
  return absl::StrCat(id.trajectory_id, ":", id.index, " ", Number(pose.x, 3),
                      " ", Number(pose.y, 3), " ", Number(pose.theta, 4));
}

// What a click on the ring shows. `name` occurs in the reason of the verdict.
Attributes RingAttributes(const MapGraph& graph, const std::string& name,
                          const double seconds,
                          const absl::optional<ScanPair>& pair) {
  Attributes attributes = {{"data-name", name}, {"data-t", Number(seconds, 1)}};
  if (!pair.has_value()) return attributes;
  attributes.emplace_back("data-words", pair->words);
  attributes.emplace_back("data-scan", ScanText(graph, pair->first));
  attributes.emplace_back("data-other", ScanText(graph, pair->second));
  return attributes;
}

void AddPieces(const ReportRun& stored, const SelfConsistency& consistency,
               const std::vector<absl::optional<ScanPair>>& pairs,
               const io::TimeNs start, MapFigure* const figure,
               Table* const table) {
  if (!consistency.places.empty()) {
    figure->Legend("nodes whose scans contradict the map", "s2");
  }
  for (const PathPiece& piece : consistency.places) {
    figure->Path(PathOfNodes(stored.graph, piece.first_node, piece.last_node),
                 "s2");
  }
  int number = 0;
  for (const PathPiece& piece : consistency.places) {
    ++number;
    std::string submaps;
    for (const GraphId& id : piece.submaps) {
      absl::StrAppend(&submaps, submaps.empty() ? "" : " ", ToString(id));
    }
    const double begin = io::ToSeconds(piece.begin - start);
    const std::string seconds = absl::StrFormat(
        "%.1f to %.1f s", begin, io::ToSeconds(piece.end - start));
    const std::string nodes = absl::StrCat(ToString(piece.first_node), " to ",
                                           ToString(piece.last_node));
    const std::string amount =
        piece.is_displaced()
            ? absl::StrFormat("%.1f m", piece.displacement)
            : absl::StrFormat("%.0f %%", 100. * piece.fraction);
    figure->Ring(
        piece.center, 0.5 * piece.metres + 1., absl::StrCat(number),
        absl::StrFormat("place %d: nodes %s\n%s\n%s submaps %s", number, nodes,
                        seconds,
                        absl::StrCat(amount, piece.is_displaced()
                                                 ? " from where they fit"
                                                 : " of the rays contradict"),
                        submaps),
        RingAttributes(stored.graph, absl::StrCat("nodes ", nodes, " ("), begin,
                       pairs[number - 1]));
    table->AddRow({absl::StrCat(number),
                   absl::StrFormat("%.1f m", piece.center.x()),
                   absl::StrFormat("%.1f m", piece.center.y()), nodes, seconds,
                   amount, absl::StrCat("submaps ", submaps)});
  }
}

void AddTurns(const ReportRun& stored, const SelfConsistency& consistency,
              const std::vector<absl::optional<ScanPair>>& pairs,
              const io::TimeNs start, MapFigure* const figure,
              Table* const table) {
  const size_t count = std::min(kMaxLetters, consistency.wrong_turns.size());
  for (size_t i = 0; i != count; ++i) {
    const MotionStep& step = consistency.wrong_turns[i];
    const std::string letter(1, static_cast<char>('A' + i));
    const auto& node = stored.graph.nodes.at(step.node_id);
    const double seconds = io::ToSeconds(step.time - start);
    const std::string name =
        absl::StrCat("before node ", ToString(step.node_id));
    figure->Ring(
        node.global_pose.translation(), 0.8, letter,
        absl::StrFormat("local SLAM and odometry differ by %.0f deg %s, %.1f s "
                        "after the start",
                        RadToDeg(step.odometry_rotation), name, seconds),
        RingAttributes(stored.graph, absl::StrCat(name, " ("), seconds,
                       pairs[consistency.places.size() + i]));
    table->AddRow({letter, absl::StrFormat("%.1f m", node.global_pose.x),
                   absl::StrFormat("%.1f m", node.global_pose.y),
                   ToString(step.node_id), absl::StrFormat("%.1f s", seconds),
                   "",
                   absl::StrFormat("odometry, by %.0f deg",
                                   RadToDeg(step.odometry_rotation))});
  }
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

std::vector<double> NodeSeconds(const evaluation::MapGraph& graph,
                                const io::TimeNs start) {
  std::vector<double> seconds;
  int trajectory_id = 0;
  for (const auto& entry : graph.nodes) {
    if (!seconds.empty() && entry.first.trajectory_id != trajectory_id) {
      seconds.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    trajectory_id = entry.first.trajectory_id;
    seconds.push_back(io::ToSeconds(entry.second.time - start));
  }
  return seconds;
}

std::vector<GraphId> NodesOfPlaces(const ReportData& data) {
  std::vector<GraphId> nodes;
  const ReportRun& stored = data.runs.front();
  if (!stored.evaluation.consistency.has_value()) return nodes;
  for (const auto& pair :
       PairsOf(stored.graph, *stored.evaluation.consistency)) {
    if (!pair.has_value()) continue;
    nodes.push_back(pair->first);
    nodes.push_back(pair->second);
  }
  return nodes;
}

void AddPlaces(const ReportData& data, const Prepared& prepared,
               Markup* const page) {
  const ReportRun& stored = data.runs.front();
  MapFigure figure("Map with the places that contradict it", prepared.bounds);
  if (!prepared.image_ids[0].empty()) figure.Image(prepared.image_ids[0]);
  figure.TimedPath(NodePath(stored.graph),
                   NodeSeconds(stored.graph, prepared.start), "by-time");
  figure.Legend("path of the robot, from start (blue) to end (magenta)",
                "by-time");
  Table table({"place", "x", "y", "nodes", "after the start",
               "rays contradicted, or displacement", "against"});
  if (stored.evaluation.consistency.has_value()) {
    const SelfConsistency& consistency = *stored.evaluation.consistency;
    const auto pairs = PairsOf(stored.graph, consistency);
    AddPieces(stored, consistency, pairs, prepared.start, &figure, &table);
    AddTurns(stored, consistency, pairs, prepared.start, &figure, &table);
  }
  page->Open("figure");
  page->Raw(figure.ToHtml());
  page->Element(
      "figcaption", {},
      "The map as stored. Numbers: path pieces whose scans are in free space "
      "or behind walls mapped by another visit, or would fit it better some "
      "decimetres away. Letters: places where the rotation of local SLAM "
      "differs from that of the wheels. Click a ring to see the two scans that "
      "do not agree.");
  page->Close();
  if (!table.empty()) page->Raw(table.ToHtml("Places that contradict the map"));
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
