// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// One occupancy map of all submaps at their optimised poses. Submaps overlap:
// each cell of the map combines all submaps in which it is known as independent
// evidence, by the sum of the log odds of occupancy.
#ifndef CARTOGRAPHER_EXT_MAP_MAP_PAINTER_H_
#define CARTOGRAPHER_EXT_MAP_MAP_PAINTER_H_

#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/map/submap_grid.h"

namespace cartographer_ext {
namespace evaluation {

// The grid of a submap. Its cells have coordinates in the local frame of the
// trajectory.
struct PlacedGrid {
  const SubmapGrid* grid = nullptr;
  Pose2 map_from_local;  // (map <- submap) * (local <- submap)^-1
};

// Resolution in metres per cell. An error if no cell is known, or if the map
// would need more than 4e8 cells, or more than 1.6e7 and 64 times the number of
// known cells. The map's edges lie on multiples of the resolution.
absl::StatusOr<io::OccupancyMap> PaintMap(const std::vector<PlacedGrid>& grids,
                                          double resolution);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_MAP_PAINTER_H_
