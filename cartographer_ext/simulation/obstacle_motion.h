// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the moving obstacles are: each walks its closed loop of waypoints at
// constant speed, from the last waypoint straight back to the first.
#ifndef CARTOGRAPHER_EXT_SIMULATION_OBSTACLE_MOTION_H_
#define CARTOGRAPHER_EXT_SIMULATION_OBSTACLE_MOTION_H_

#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/simulation/ray_caster.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

class ObstacleMotion {
 public:
  // The seed sets the phase of obstacles whose phase is random.
  ObstacleMotion(const std::vector<MovingObstacle>& obstacles, uint64_t seed);

  size_t size() const { return loops_.size(); }
  double radius(size_t obstacle) const { return loops_[obstacle].radius; }
  // Centre in the world, `time` seconds after the start of the drive.
  Eigen::Vector2d Position(size_t obstacle, double time) const;
  Disc DiscAt(size_t obstacle, double time) const;
  // All of them.
  std::vector<Disc> At(double time) const;

 private:
  struct Loop {
    double radius = 0.;
    double speed = 0.;
    double start = 0.;                  // metres along the loop at time 0
    std::vector<Eigen::Vector2d> path;  // first point repeated at the end
    std::vector<double> distances;      // metres from the first point
  };

  std::vector<Loop> loops_;
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_OBSTACLE_MOTION_H_
