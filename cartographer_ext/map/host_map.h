// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The map of a running or finished host, in plain types.
#ifndef CARTOGRAPHER_EXT_MAP_HOST_MAP_H_
#define CARTOGRAPHER_EXT_MAP_HOST_MAP_H_

#include "absl/status/statusor.h"
#include "cartographer/mapping/pose_graph_interface.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/map/map_graph.h"

namespace cartographer_ext {
namespace evaluation {

MapGraph MakeMapGraph(
    const cartographer::mapping::PoseGraphInterface& pose_graph);

// Paints all submaps; resolution in metres per cell.
absl::StatusOr<io::OccupancyMap> PaintHostMap(
    const cartographer::mapping::PoseGraphInterface& pose_graph,
    double resolution);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_HOST_MAP_H_
