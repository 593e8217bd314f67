// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the live laser sees that the finished map does not have.
//
// An echo farther than `wall_tolerance` from every wall of the map marks its
// cell. A beam clears the marks of the cells that it passes; only cells within
// `range` of the laser are touched, so the layer rolls along with the robot.
// Marks out of sight are kept for `memory_seconds`, which is how a closed door
// is remembered while the robot looks for another path. Those that have not
// been there for `settle_seconds` yet, as of somebody who walked by, are
// forgotten sooner.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_OBSTACLE_LAYER_H_
#define CARTOGRAPHER_EXT_NAVIGATION_OBSTACLE_LAYER_H_

#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/navigation/costmap.h"

namespace cartographer_ext {
namespace navigation {

struct ObstacleLayerOptions {
  double range = 6.;             // metres from the laser
  double wall_tolerance = 0.15;  // metres
  double memory_seconds = 60.;
  double settle_seconds = 1.;
  double unsettled_memory_seconds = 1.5;
  // Most marks kept; the oldest go first.
  int max_marks = 20000;
};

// A scan in the map. Beams without an echo have the end of their range in
// `free_ends`: they clear but do not mark.
struct ScanInMap {
  double time = 0.;  // seconds
  Eigen::Vector2d laser = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> echoes;
  std::vector<Eigen::Vector2d> free_ends;
};

class ObstacleLayer {
 public:
  // The costmap must outlive the layer.
  ObstacleLayer(const Costmap* costmap, const ObstacleLayerOptions& options);

  // Points that are not finite are ignored.
  void Update(const ScanInMap& scan);
  // Forgets all marks within `radius` metres.
  void Clear(const Eigen::Vector2d& center, double radius);

  bool IsMarked(const Cell& cell) const;
  // Seconds since the oldest mark in the cell of a point or beside it was made;
  // 0 where there is none.
  double MarkAge(const Eigen::Vector2d& point, double now) const;
  // Cells that are marked, in order of their first mark.
  const std::vector<Cell>& marks() const { return marks_; }

  // Whether the map explains an echo by one of its walls.
  bool IsWall(const Eigen::Vector2d& echo) const;

  // The weights of the map with all marks inflated.
  void ApplyTo(WeightGrid* weights) const;

 private:
  // Forgets the marks whose time was reset, those that are too old, and the
  // oldest of too many.
  void Compact(double now);
  // Clears the marks between the laser and an end of a beam.
  void ClearBeam(const Eigen::Vector2d& laser, const Eigen::Vector2d& end,
                 bool keep_end);

  struct StampedWeight {
    int dx, dy;
    uint8_t weight;
  };

  const Costmap* const costmap_;
  const ObstacleLayerOptions options_;
  std::vector<float> times_;        // of the last mark of each cell; NaN: none
  std::vector<float> first_times_;  // since when it is marked
  std::vector<Cell> marks_;
  std::vector<StampedWeight> stamp_;  // of one mark on the weights around it
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_OBSTACLE_LAYER_H_
