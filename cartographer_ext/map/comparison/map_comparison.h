// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Differences between two maps of one place: the maps are aligned, walls are
// classified as in one, in the other or in both, and displaced parts are listed
// with their displacement.
#ifndef CARTOGRAPHER_EXT_MAP_COMPARISON_MAP_COMPARISON_H_
#define CARTOGRAPHER_EXT_MAP_COMPARISON_MAP_COMPARISON_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "absl/types/optional.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/map/comparison/map_alignment.h"
#include "cartographer_ext/map/map_graph.h"
#include "nlohmann/json.hpp"

namespace cartographer_ext {
namespace evaluation {

struct ComparisonOptions {
  double tolerance = 0.15;  // metres: walls within this distance are the same
  double moved = 0.2;       // metres: nodes that moved more are listed
  double occupied = 0.6;    // probability from which a cell is a wall
  size_t max_listed = 20;   // path pieces and walls
  int piece_break = 3;      // unmoved nodes that do not end a piece
  double min_wall_metres = 0.5;  // extent of walls of one map worth listing
};

// One of the two; the graph may be null (a PGM has none).
struct MapToCompare {
  const MapGraph* graph = nullptr;
  const io::OccupancyMap* map = nullptr;
};

// Consecutive nodes that are displaced in the other map.
struct MovedPiece {
  GraphId first_node, last_node;
  io::TimeNs begin = 0, end = 0;
  int nodes = 0;
  double mean = 0., max = 0.;      // metres
  double max_rotation = 0.;        // radians
  Eigen::Vector2d center{0., 0.};  // in the first map
};

// Connected walls in only one map.
struct LoneWalls {
  bool in_first = true;
  Eigen::Vector2d center{0., 0.};  // in the first map
  double extent = 0.;              // metres, the longer side
  int cells = 0;
};

struct TrajectoryDifference {
  int64_t nodes = 0;
  double mean = 0., max = 0.;  // metres
};

struct MapComparison {
  std::string method;  // "nodes" or "walls"
  Pose2 first_from_second;
  double agreement = 0.;  // see MapAlignment
  // Absent without common nodes.
  absl::optional<TrajectoryDifference> trajectory;
  std::vector<MovedPiece> moved;  // the furthest first
  // Walls of each class as cells, in the first map's frame.
  std::vector<Eigen::Vector2d> common, only_first, only_second;
  double resolution = 0.;             // metres per cell
  std::vector<LoneWalls> lone_walls;  // the largest first
};

// Centres of the cells that are walls, in the frame of the map.
std::vector<Eigen::Vector2d> WallsOf(const io::OccupancyMap& map,
                                     double occupied);

// NotFound if the maps cannot be aligned, InvalidArgument if one has no walls.
// Both maps should have the same resolution.
absl::StatusOr<MapComparison> CompareMaps(const MapToCompare& first,
                                          const MapToCompare& second,
                                          const ComparisonOptions& options);

nlohmann::ordered_json ToJson(const MapComparison& comparison);

// Several lines of text, with a final line break.
std::string ToText(const MapComparison& comparison);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_COMPARISON_MAP_COMPARISON_H_
