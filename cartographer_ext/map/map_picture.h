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
// constraints as lines from submap to node: those that the map agrees with to
// half a metre in one colour, the others in another. Nodes that MarkMatches has
// marked get a dash along the direction that their scan did not determine, or a
// dot where odometry was at fault. Atomically.
absl::Status WriteMapPicture(const io::OccupancyMap& map, const MapGraph& graph,
                             const std::string& title,
                             const std::string& filename);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_MAP_PICTURE_H_
