// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Disturbances that the map does not show: obstacles put in the robot's path,
// people who cross suddenly, doors that close. All are discs; a closed door is
// a row of them.
//
// Positions are drawn along the shortest paths between the goals, so that the
// robot meets them. A disturbance appears when the robot is near, but never
// nearer than it can react to. Stationary ones leave a path to every goal, and
// each obstacle leaves `spare_width` beside it: only doors close a passage.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_DISTURBANCES_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_DISTURBANCES_H_

#include <cstdint>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/simulation/ray_caster.h"

namespace cartographer_ext {
namespace navigation {

struct DisturbanceOptions {
  int obstacles = 0;
  int crossings = 0;
  int doors = 0;
  double robot_radius = 0.25;  // metres
  // Free beside an obstacle on at least one side, on top of the robot's width.
  double spare_width = 0.25;
  double min_distance = 1.5;  // metres from the robot at which they appear
};

struct Disturbance {
  enum class Kind { kObstacle, kCrossing, kDoor };
  Kind kind = Kind::kObstacle;
  double trigger = 0.;  // metres from the robot
  std::vector<simulation::Disc> discs;
  // Of a crossing: from where the disc is to here, at this speed.
  Eigen::Vector2d end = Eigen::Vector2d::Zero();
  double speed = 0.;  // m/s
  bool present = false;
  bool over = false;
  double begin = 0.;  // seconds
};

const char* ToString(Disturbance::Kind kind);

class Disturbances {
 public:
  // `legs` are paths in the world frame, each from goal to goal. An error
  // where there is no room for as many as asked for.
  static absl::StatusOr<Disturbances> Create(
      const simulation::RayCaster& plan,
      const std::vector<std::vector<Eigen::Vector2d>>& legs,
      const DisturbanceOptions& options, uint64_t seed);

  // Triggers the disturbances that are due with the robot at this position.
  void Update(double time, const Eigen::Vector2d& robot);

  const std::vector<Disturbance>& all() const { return disturbances_; }
  // At the time of the last update.
  const std::vector<simulation::Disc>& stationary() const {
    return stationary_;
  }
  const std::vector<simulation::Disc>& moving() const { return moving_; }

 private:
  static absl::StatusOr<Disturbances> Draw(
      const simulation::RayCaster& plan,
      const std::vector<std::vector<Eigen::Vector2d>>& legs,
      const DisturbanceOptions& options, Random* random);

  std::vector<Disturbance> disturbances_;
  std::vector<simulation::Disc> stationary_;
  std::vector<simulation::Disc> moving_;
  double min_distance_ = 0.;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_DISTURBANCES_H_
