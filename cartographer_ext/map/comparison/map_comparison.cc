// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/map/comparison/map_comparison.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/map/comparison/point_index.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using nlohmann::ordered_json;

// Below this share of unmoved nodes the walls may fit better: stamps of two
// simulated runs are alike, too.
constexpr double kMostNodes = 0.5;
// Below this share the stamps are alike by chance.
constexpr double kSameRun = 0.1;

// Of `walls`, those with a wall of `others` near them, and the rest.
void Sort(const std::vector<Eigen::Vector2d>& walls,
          const std::vector<Eigen::Vector2d>& others, const double tolerance,
          std::vector<Eigen::Vector2d>* const common,
          std::vector<Eigen::Vector2d>* const alone) {
  const PointIndex index(others, tolerance);
  for (const Eigen::Vector2d& wall : walls) {
    (index.Nearest(wall) >= 0 ? common : alone)->push_back(wall);
  }
}

void AddLoneWalls(const std::vector<Eigen::Vector2d>& walls,
                  const bool in_first, const double reach,
                  const double min_extent, MapComparison* const result) {
  using Cell = std::pair<int64_t, int64_t>;
  const auto cell_of = [reach](const Eigen::Vector2d& point) {
    return Cell(static_cast<int64_t>(std::floor(point.x() / reach)),
                static_cast<int64_t>(std::floor(point.y() / reach)));
  };
  std::map<Cell, std::vector<size_t>> cells;
  for (size_t i = 0; i < walls.size(); ++i) {
    cells[cell_of(walls[i])].push_back(i);
  }
  std::set<Cell> seen;
  for (const auto& start : cells) {
    if (!seen.insert(start.first).second) continue;
    std::deque<Cell> open = {start.first};
    LoneWalls group;
    group.in_first = in_first;
    Eigen::Vector2d low = walls[start.second.front()], high = low;
    while (!open.empty()) {
      const Cell cell = open.front();
      open.pop_front();
      for (const size_t i : cells[cell]) {
        ++group.cells;
        group.center += walls[i];
        low = low.cwiseMin(walls[i]);
        high = high.cwiseMax(walls[i]);
      }
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const Cell next(cell.first + dx, cell.second + dy);
          if (cells.count(next) != 0 && seen.insert(next).second) {
            open.push_back(next);
          }
        }
      }
    }
    group.center /= static_cast<double>(group.cells);
    group.extent = (high - low).maxCoeff();
    if (group.extent >= min_extent) result->lone_walls.push_back(group);
  }
}

void FindMoved(const std::vector<CommonNode>& nodes,
               const ComparisonOptions& options, MapComparison* const result) {
  TrajectoryDifference difference;
  MovedPiece piece;
  int quiet = 0;
  const auto close = [&]() {
    if (piece.nodes > 0) {
      piece.mean /= piece.nodes;
      piece.center /= static_cast<double>(piece.nodes);
      result->moved.push_back(piece);
    }
    piece = MovedPiece();
    quiet = 0;
  };
  for (const CommonNode& node : nodes) {
    const GraphId& id = node.id;
    const Pose2& here = node.poses.first;
    const Pose2 moved = result->first_from_second * node.poses.second;
    const double metres = (moved.translation() - here.translation()).norm();
    ++difference.nodes;
    difference.mean += metres;
    difference.max = std::max(difference.max, metres);
    if (piece.nodes > 0 && (piece.last_node.trajectory_id != id.trajectory_id ||
                            quiet > options.piece_break)) {
      close();
    }
    if (metres <= options.moved) {
      ++quiet;
      continue;
    }
    if (piece.nodes == 0) {
      piece.first_node = id;
      piece.begin = node.time;
    }
    quiet = 0;
    ++piece.nodes;
    piece.last_node = id;
    piece.end = node.time;
    piece.mean += metres;
    piece.max = std::max(piece.max, metres);
    piece.max_rotation = std::max(
        piece.max_rotation, std::abs(NormalizeAngle(moved.theta - here.theta)));
    piece.center += here.translation();
  }
  close();
  difference.mean /= static_cast<double>(difference.nodes);
  result->trajectory = difference;
  std::stable_sort(
      result->moved.begin(), result->moved.end(),
      [](const MovedPiece& a, const MovedPiece& b) { return a.max > b.max; });
  if (result->moved.size() > options.max_listed) {
    result->moved.resize(options.max_listed);
  }
}

// Stores the share of the nodes whose poses agree in `nodes_agree`.
absl::Status Align(const std::vector<CommonNode>& nodes,
                   const std::vector<Eigen::Vector2d>& first,
                   const std::vector<Eigen::Vector2d>& second,
                   const ComparisonOptions& options, double* const nodes_agree,
                   MapComparison* const result) {
  std::vector<NodePosePair> pairs;
  for (const CommonNode& node : nodes) pairs.push_back(node.poses);
  const auto by_nodes = AlignPoses(pairs, options.moved);
  *nodes_agree = 0.;
  if (by_nodes.has_value()) {
    *nodes_agree = by_nodes->agreement;
    result->method = "nodes";
    result->first_from_second = by_nodes->first_from_second;
    result->agreement = by_nodes->agreement;
    if (by_nodes->agreement >= kMostNodes) return absl::OkStatus();
  }
  const auto by_walls = AlignWalls(first, second, options.tolerance);
  if (!by_walls.has_value()) {
    if (*nodes_agree >= kSameRun) return absl::OkStatus();
    return absl::NotFoundError(
        "the maps cannot be aligned: no pose puts a fifth of the walls of one "
        "onto walls of the other");
  }
  if (*nodes_agree >= kSameRun) {
    const MapAlignment walls_of_nodes =
        RefineWalls(first, second, by_nodes->first_from_second,
                    options.tolerance, options.tolerance);
    if (walls_of_nodes.agreement >= by_walls->agreement) {
      return absl::OkStatus();
    }
  }
  result->method = "walls";
  result->first_from_second = by_walls->first_from_second;
  result->agreement = by_walls->agreement;
  return absl::OkStatus();
}

ordered_json PointJson(const Eigen::Vector2d& point) {
  return {{"x", point.x()}, {"y", point.y()}};
}

}  // namespace

std::vector<Eigen::Vector2d> WallsOf(const io::OccupancyMap& map,
                                     const double occupied) {
  std::vector<Eigen::Vector2d> walls;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const float value = map.at(x, y);
      if (!(value >= occupied)) continue;
      walls.push_back(map.origin * Eigen::Vector2d((x + 0.5) * map.resolution,
                                                   (y + 0.5) * map.resolution));
    }
  }
  return walls;
}

absl::StatusOr<MapComparison> CompareMaps(const MapToCompare& first,
                                          const MapToCompare& second,
                                          const ComparisonOptions& options) {
  const std::vector<Eigen::Vector2d> walls =
      WallsOf(*first.map, options.occupied);
  std::vector<Eigen::Vector2d> others = WallsOf(*second.map, options.occupied);
  if (walls.empty() || others.empty()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the %s map has no walls", walls.empty() ? "first" : "second"));
  }
  MapComparison result;
  result.resolution = first.map->resolution;
  std::vector<CommonNode> nodes;
  if (first.graph != nullptr && second.graph != nullptr) {
    nodes = FindCommonNodes(*first.graph, *second.graph);
  }
  double nodes_agree = 0.;
  const absl::Status aligned =
      Align(nodes, walls, others, options, &nodes_agree, &result);
  if (!aligned.ok()) return aligned;
  if (!nodes.empty() && nodes_agree >= kSameRun) {
    FindMoved(nodes, options, &result);
  }
  for (Eigen::Vector2d& wall : others) wall = result.first_from_second * wall;
  Sort(walls, others, options.tolerance, &result.common, &result.only_first);
  std::vector<Eigen::Vector2d> common_of_second;
  Sort(others, walls, options.tolerance, &common_of_second,
       &result.only_second);
  const double reach = 2. * options.tolerance;
  AddLoneWalls(result.only_first, true, reach, options.min_wall_metres,
               &result);
  AddLoneWalls(result.only_second, false, reach, options.min_wall_metres,
               &result);
  std::stable_sort(
      result.lone_walls.begin(), result.lone_walls.end(),
      [](const LoneWalls& a, const LoneWalls& b) { return a.cells > b.cells; });
  if (result.lone_walls.size() > options.max_listed) {
    result.lone_walls.resize(options.max_listed);
  }
  return result;
}

ordered_json ToJson(const MapComparison& comparison) {
  ordered_json json;
  json["alignment"] = {{"x", comparison.first_from_second.x},
                       {"y", comparison.first_from_second.y},
                       {"theta", comparison.first_from_second.theta},
                       {"method", comparison.method},
                       {"agreement", comparison.agreement}};
  if (comparison.trajectory.has_value()) {
    json["trajectory_difference"] = {{"mean", comparison.trajectory->mean},
                                     {"max", comparison.trajectory->max},
                                     {"nodes", comparison.trajectory->nodes}};
  } else {
    json["trajectory_difference"] = {
        {"mean", nullptr}, {"max", nullptr}, {"nodes", 0}};
  }
  json["walls"] = {{"common", comparison.common.size()},
                   {"only_first", comparison.only_first.size()},
                   {"only_second", comparison.only_second.size()},
                   {"resolution", comparison.resolution}};
  json["moved"] = ordered_json::array();
  for (const MovedPiece& piece : comparison.moved) {
    json["moved"].push_back(
        {{"first_node", ToString(piece.first_node)},
         {"last_node", ToString(piece.last_node)},
         {"begin_seconds", io::ToSeconds(piece.begin)},
         {"end_seconds", io::ToSeconds(piece.end)},
         {"nodes", piece.nodes},
         {"mean", piece.mean},
         {"max", piece.max},
         {"max_rotation_degrees", RadToDeg(piece.max_rotation)},
         {"center", PointJson(piece.center)}});
  }
  json["lone_walls"] = ordered_json::array();
  for (const LoneWalls& group : comparison.lone_walls) {
    json["lone_walls"].push_back({{"in", group.in_first ? "first" : "second"},
                                  {"center", PointJson(group.center)},
                                  {"extent", group.extent},
                                  {"cells", group.cells}});
  }
  return json;
}

std::string ToText(const MapComparison& comparison) {
  const Pose2& pose = comparison.first_from_second;
  std::string text = absl::StrFormat(
      "Alignment    second map to first: translation %.3f m, %.3f m, rotation "
      "%.2f deg (by %s, %.0f %% agree)\n",
      pose.x, pose.y, RadToDeg(pose.theta), comparison.method,
      100. * comparison.agreement);
  if (comparison.trajectory.has_value()) {
    absl::StrAppendFormat(&text,
                          "Trajectory   %d common nodes differ by %.3f m on "
                          "average, %.3f m at most\n",
                          comparison.trajectory->nodes,
                          comparison.trajectory->mean,
                          comparison.trajectory->max);
  } else {
    text += "Trajectory   no common nodes: two runs, or a map without nodes\n";
  }
  absl::StrAppendFormat(&text,
                        "Walls        %d cells in both maps, %d in the first "
                        "only, %d in the second only\n",
                        comparison.common.size(), comparison.only_first.size(),
                        comparison.only_second.size());
  for (const MovedPiece& piece : comparison.moved) {
    absl::StrAppendFormat(
        &text,
        "  moved by %.2f m (at most %.2f m, %.1f deg): nodes %s to %s near "
        "x = %.1f m, y = %.1f m\n",
        piece.mean, piece.max, RadToDeg(piece.max_rotation),
        ToString(piece.first_node), ToString(piece.last_node), piece.center.x(),
        piece.center.y());
  }
  for (const LoneWalls& group : comparison.lone_walls) {
    absl::StrAppendFormat(
        &text,
        "  only in the %s: %.1f m of walls near x = %.1f m, y = %.1f "
        "m\n",
        group.in_first ? "first" : "second", group.extent, group.center.x(),
        group.center.y());
  }
  return text;
}

}  // namespace evaluation
}  // namespace cartographer_ext
