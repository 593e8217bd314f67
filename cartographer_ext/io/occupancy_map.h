// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Occupancy maps in the format of map_server and nav2: a grey PGM picture and a
// YAML file with its resolution and origin.
#ifndef CARTOGRAPHER_EXT_IO_OCCUPANCY_MAP_H_
#define CARTOGRAPHER_EXT_IO_OCCUPANCY_MAP_H_

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace io {

struct OccupancyMap {
  int width = 0;           // cells along x
  int height = 0;          // cells along y
  double resolution = 0.;  // metres per cell
  Pose2 origin;            // (map <- lower left corner of cell (0, 0))
  // Probability of occupancy, NaN where unknown. Row by row from the bottom
  // (smallest y) up: cell (x, y) is at y * width + x.
  std::vector<float> occupancy;

  static float Unknown() { return std::numeric_limits<float>::quiet_NaN(); }
  // All cells unknown.
  static OccupancyMap Make(int width, int height, double resolution,
                           const Pose2& origin);
  float at(int x, int y) const { return occupancy[y * width + x]; }
  float& at(int x, int y) { return occupancy[y * width + x]; }
};

// Writes `filestem`.pgm (P5: 0 occupied to 255 free, 128 unknown, as
// Cartographer does) and `filestem`.yaml (mode trinary, occupied_thresh 0.65,
// free_thresh 0.196, image relative to the YAML file), both atomically.
absl::Status WriteOccupancyMap(const OccupancyMap& map,
                               const std::string& filestem);

// Reads a map by its YAML file. P2 and P5 pictures; modes trinary (the default:
// 0, 1 or unknown by the two thresholds), scale (linear between them) and raw
// (0 to 100 per cent, others unknown); negate. Errors name file and key or
// line.
absl::StatusOr<OccupancyMap> ReadOccupancyMap(const std::string& yaml_filename);

}  // namespace io
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_IO_OCCUPANCY_MAP_H_
