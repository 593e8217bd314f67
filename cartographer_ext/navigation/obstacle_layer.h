// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Obstacles that the laser sees and the finished map lacks.
//
// An echo farther than `wall_tolerance` from every wall of the map marks its
// cell. A beam clears the marks of the cells that it passes; only cells within
// `range` of the laser are touched, so the layer rolls along with the robot.
// Marks out of sight are kept for `memory_seconds`, so that a closed door is
// remembered while the robot takes another path. Marks younger than
// `settle_seconds`, as of somebody who walks past, are forgotten sooner, and no
// path is planned around them: it would be wrong a moment later. The dynamic
// window avoids all of them.
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
  // A mark that a beam clears and another one makes again within this time was
  // there all the while: beams graze the cells at the border of an obstacle.
  double renewal_seconds = 0.5;
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
  // Forgets the marks within `radius` metres that have not been made again
  // since a time.
  void Clear(const Eigen::Vector2d& center, double radius, double since);

  // Keeps the settled marks within `radius` metres until that time (seconds)
  // unless a beam clears them: the obstacle behind a long detour must not be
  // forgotten while the robot drives it.
  void Keep(const Eigen::Vector2d& center, double radius, double until);
  // Marks that are kept are forgotten like all others again.
  void LetGo();

  bool IsMarked(const Cell& cell) const;
  // Seconds since the oldest mark in the cell of a point or beside it was made;
  // 0 where there is none.
  double MarkAge(const Eigen::Vector2d& point, double now) const;
  // Whether there has been a mark for `settle_seconds`.
  bool IsSettled(const Cell& cell) const;
  // Cells that are marked, in order of their first mark.
  const std::vector<Cell>& marks() const { return marks_; }

  // Whether the map explains an echo by one of its walls.
  bool IsWall(const Eigen::Vector2d& echo) const;

  // The weights of the map with all settled marks inflated.
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
  std::vector<float> past_times_;   // of the last mark that was cleared
  std::vector<float> kept_until_;   // 0: as long as others
  std::vector<Cell> marks_;
  std::vector<StampedWeight> stamp_;  // of one mark on the weights around it
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_OBSTACLE_LAYER_H_
