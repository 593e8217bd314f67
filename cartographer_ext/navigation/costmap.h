// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The configuration space of a robot in a finished occupancy map: which cells
// its centre may occupy, and at what cost.
//
// With d the exact distance from the centre of a cell to the centre of the
// nearest cell that is occupied or unknown, r the inscribed radius of the
// footprint plus the padding, s the width of the tight zone and R the inflation
// radius,
//   d <= r      blocked,
//   d <= r + s  the highest weight, kMaxWeight,
//   d >= R      weight 1,
//   otherwise   1 + clearance_weight ((R - d) / (R - r - s))^2,
// in units of GridSearch's kMinWeight: a metre of path costs between 1 and
// 1 + clearance_weight metres, and 16 where it is tight. The position of an
// echo is known to within a cell only. Without the tight cells a narrow passage
// would open and close from scan to scan, and the path would change sides of an
// obstacle.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_COSTMAP_H_
#define CARTOGRAPHER_EXT_NAVIGATION_COSTMAP_H_

#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/navigation/grid_geometry.h"
#include "cartographer_ext/navigation/grid_search.h"

namespace cartographer_ext {
namespace navigation {

struct CostmapOptions {
  double inscribed_radius = 0.25;  // metres, of the footprint
  double padding = 0.05;           // metres, on top of it
  double tight = 0.05;             // metres, one cell: added to both
  double inflation_radius = 0.9;   // metres, at least these three
  double clearance_weight = 4.;    // at most kMaxWeight / kMinWeight - 1
  // A cell of at least this probability is occupied, any other known one is
  // free.
  double occupied_probability = 0.55;
  // Whether the robot may enter unknown space.
  bool unknown_is_free = false;
};

enum class CellState : uint8_t { kFree, kOccupied, kUnknown };

class Costmap {
 public:
  // Errors: options out of range, a map that is empty, too large, or has no
  // cell that is free.
  static absl::StatusOr<Costmap> Create(const io::OccupancyMap& map,
                                        const CostmapOptions& options);

  const GridGeometry& geometry() const { return geometry_; }
  const CostmapOptions& options() const { return options_; }
  const WeightGrid& weights() const { return weights_; }

  // Cells outside the map are unknown.
  CellState state(const Cell& cell) const;
  // Metres to the nearest cell that is occupied, or unknown where that is not
  // free; 0 outside.
  double ObstacleDistance(const Cell& cell) const;
  // Metres to the nearest occupied cell; infinite outside.
  double WallDistance(const Cell& cell) const;
  double WallDistance(const Eigen::Vector2d& point) const;
  // Weight of a cell at that distance from an obstacle.
  uint8_t WeightAt(double distance) const;

 private:
  Costmap() = default;

  CostmapOptions options_;
  GridGeometry geometry_;
  std::vector<CellState> states_;
  std::vector<float> obstacle_distances_;
  std::vector<float> wall_distances_;
  WeightGrid weights_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_COSTMAP_H_
