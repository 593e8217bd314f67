// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a robot meets that its map does not show: things that
// are put in its path, people who cross suddenly, doors that close. All of it
// is round; a closed door is a row of discs.
//
// Places are drawn along the shortest paths between the goals, so that the
// robot meets them; they come to be when it is near, but never nearer than it
// can react to. Stationary things leave a path to every goal, and each obstacle
// leaves `spare_width` beside it: what closes a way is a door.
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
  double min_distance = 1.5;  // metres from the robot at which they come to be
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

  // Lets happen what is due with the robot at that place.
  void Update(double time, const Eigen::Vector2d& robot);

  const std::vector<Disturbance>& all() const { return disturbances_; }
  // At the time of the last update.
  const std::vector<simulation::Disc>& standing() const { return standing_; }
  const std::vector<simulation::Disc>& moving() const { return moving_; }

 private:
  static absl::StatusOr<Disturbances> Draw(
      const simulation::RayCaster& plan,
      const std::vector<std::vector<Eigen::Vector2d>>& legs,
      const DisturbanceOptions& options, Random* random);

  std::vector<Disturbance> disturbances_;
  std::vector<simulation::Disc> standing_;
  std::vector<simulation::Disc> moving_;
  double min_distance_ = 0.;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_DISTURBANCES_H_
