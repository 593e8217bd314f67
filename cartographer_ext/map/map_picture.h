// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_MAP_MAP_PICTURE_H_
#define CARTOGRAPHER_EXT_MAP_MAP_PICTURE_H_

#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

// A PNG of the map with the path of the robot through its nodes and the loop
// constraints as lines from submap to node: those with a residual of at most
// half a metre in one colour, the others in another. Nodes marked by
// MarkMatches get a dash along the degenerate direction of their scan, or a dot
// for an odometry fault. Atomically. No copy is made of a map that is moved.
absl::Status WriteMapPicture(io::OccupancyMap map, const MapGraph& graph,
                             const std::string& title,
                             const std::string& filename);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_MAP_PICTURE_H_
