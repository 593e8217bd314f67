// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/pose_graph_files.h"

#include <algorithm>
#include <iostream>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/io/picture.h"
#include "cartographer_ext/optimization/offline/graph_metrics.h"
#include "cartographer_ext/optimization/offline/starts/starts.h"

namespace cartographer_ext {
namespace evaluation {

using optimization::OptimizeResult;
using optimization::PoseGraph;
using optimization::PoseGraphEdge;

absl::StatusOr<PoseGraph> ToPoseGraph(const io::G2oGraph& g2o) {
  PoseGraph graph;
  std::map<int64_t, int> index_of_id;
  for (const auto& vertex : g2o.vertices) {
    index_of_id[vertex.first] = graph.poses.size();
    graph.ids.push_back(vertex.first);
    graph.poses.push_back(vertex.second);
  }
  for (const io::G2oEdge& from_file : g2o.edges) {
    const auto from = index_of_id.find(from_file.from);
    const auto to = index_of_id.find(from_file.to);
    if (from == index_of_id.end() || to == index_of_id.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat("edge ", from_file.from, " -> ", from_file.to,
                       " names a vertex that does not exist"));
    }
    PoseGraphEdge edge;
    edge.from = from->second;
    edge.to = to->second;
    edge.measurement = from_file.measurement;
    edge.information = from_file.information;
    graph.edges.push_back(edge);
  }
  for (const int64_t id : g2o.fixed) {
    const auto index = index_of_id.find(id);
    if (index == index_of_id.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat("FIX names vertex ", id, ", which does not exist"));
    }
    graph.fixed.push_back(index->second);
  }
  optimization::MarkLoops(&graph);
  const absl::Status status = optimization::ValidatePoseGraph(graph);
  if (!status.ok()) return status;
  if (g2o.lacks_vertices) graph.poses = optimization::ChainOdometry(graph);
  return graph;
}

absl::StatusOr<PoseGraph> ReadPoseGraph(const std::string& filename) {
  const auto g2o = io::ReadG2o(filename);
  if (!g2o.ok()) return g2o.status();
  for (const auto& element : g2o->skipped) {
    std::cerr << filename << ": skipped " << element.second << " lines of "
              << element.first
              << ": only poses and edges between them are used\n";
  }
  auto graph = ToPoseGraph(*g2o);
  if (!graph.ok()) {
    return absl::Status(graph.status().code(),
                        absl::StrCat(filename, ": ", graph.status().message()));
  }
  return graph;
}

absl::Status WritePoseGraph(const PoseGraph& graph,
                            const std::vector<Pose2>& poses,
                            const std::string& filename) {
  io::G2oGraph g2o;
  for (size_t i = 0; i != poses.size(); ++i) {
    g2o.vertices[graph.ids[i]] = poses[i];
  }
  for (const PoseGraphEdge& edge : graph.edges) {
    io::G2oEdge output;
    output.from = graph.ids[edge.from];
    output.to = graph.ids[edge.to];
    output.measurement = edge.measurement;
    output.information = edge.information;
    g2o.edges.push_back(output);
  }
  for (const int pose : graph.fixed) g2o.fixed.insert(graph.ids[pose]);
  return io::WriteG2o(g2o, filename);
}

absl::StatusOr<std::vector<Pose2>> ReadTruth(const PoseGraph& graph,
                                             const std::vector<Pose2>& estimate,
                                             const std::string& filename) {
  const auto truth = io::ReadPosesById(filename);
  if (!truth.ok()) return truth.status();
  std::vector<Pose2> result;
  for (const int64_t id : graph.ids) {
    const auto it = truth->find(id);
    if (it == truth->end()) break;
    result.push_back(it->second);
  }
  if (result.size() == graph.ids.size()) return result;
  if (truth->size() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat(filename, ": too few poses for a comparison"));
  }
  std::vector<Pose2> path;
  for (const auto& id_pose : *truth) path.push_back(id_pose.second);
  result.clear();
  for (const int j : optimization::AssociateByPath(estimate, path)) {
    result.push_back(path[j]);
  }
  return result;
}

std::string VerdictTable(const PoseGraph& graph, const OptimizeResult& result) {
  std::string table = "edge,from,to,chi2,weight,accepted\n";
  for (size_t i = 0; i != graph.edges.size(); ++i) {
    const PoseGraphEdge& edge = graph.edges[i];
    if (!edge.is_loop) continue;
    absl::StrAppendFormat(&table, "%d,%d,%d,%.6g,%.6g,%d\n", i,
                          graph.ids[edge.from], graph.ids[edge.to],
                          result.chi2[i], result.weights[i],
                          result.accepted[i] ? 1 : 0);
  }
  return table;
}

absl::Status WriteComparisonPicture(const PoseGraph& graph,
                                    const OptimizeResult& result,
                                    const std::string& title,
                                    const std::string& filename) {
  io::PictureBounds before, after;
  for (const Pose2& pose : graph.poses) before.Add(pose.translation());
  for (const Pose2& pose : result.poses) after.Add(pose.translation());
  // The second panel is to the right, its lower edge level with the first.
  const double gap =
      0.1 * std::max(before.max_x - before.min_x, after.max_x - after.min_x);
  const Eigen::Vector2d shift(before.max_x + gap - after.min_x,
                              before.min_y - after.min_y);
  io::PictureBounds bounds = before;
  bounds.Add(Eigen::Vector2d(after.min_x, after.min_y) + shift);
  bounds.Add(Eigen::Vector2d(after.max_x, after.max_y) + shift);
  io::Picture picture(bounds, 2400);
  for (const bool second : {false, true}) {
    const std::vector<Pose2>& poses = second ? result.poses : graph.poses;
    const auto place = [&](const int i) {
      return Eigen::Vector2d(poses[i].translation() +
                             (second ? shift : Eigen::Vector2d::Zero()));
    };
    // Rejected loops first, so that they do not hide the map.
    for (const bool accepted : {false, true}) {
      io::Color color =
          accepted ? io::palette::kGreen : io::palette::kVermilion;
      color.alpha = accepted ? 0.7 : 0.25;
      for (size_t i = 0; i != graph.edges.size(); ++i) {
        const PoseGraphEdge& edge = graph.edges[i];
        if (edge.is_loop && result.accepted[i] == accepted) {
          picture.DrawLine(place(edge.from), place(edge.to), {color, 1.});
        }
      }
    }
    for (const PoseGraphEdge& edge : graph.edges) {
      if (!edge.is_loop) {
        picture.DrawLine(place(edge.from), place(edge.to),
                         {io::palette::kBlue, 1.5});
      }
    }
  }
  picture.SetTitle(absl::StrCat(title, "  (left: before, right: after)"));
  picture.AddLegend("odometry", io::palette::kBlue);
  picture.AddLegend("loop in force", io::palette::kGreen);
  picture.AddLegend("disabled loop", io::palette::kVermilion);
  return picture.Write(filename);
}

}  // namespace evaluation
}  // namespace cartographer_ext
