// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The dynamic window approach of Fox, Burgard and Thrun, "The dynamic window
// approach to collision avoidance", IEEE Robotics and Automation Magazine 4(1),
// 1997. Equations by their numbers there.
//
// Of all velocities (v, w), each of which is a circular arc, only those are
// considered that can be reached within one control period (the dynamic window
// V_d, eq. 15) and from which the robot can stop before it touches anything
// (the admissible velocities V_a, eq. 14):
//   v <= sqrt(2 dist(v, w) b),   |w| <= sqrt(2 dist(v, w) |w / v| b_w),
// with dist(v, w) the free length of the arc. Here a reaction time t is
// added: v t + v^2 / (2 b) <= dist. Among these the objective (eq. 13, each
// term in [0, 1]) is greatest:
//
//   G = alpha heading + beta dist + gamma velocity + delta path
//       + epsilon margin
//
// with two terms that the paper does not have: how near the arc stays to the
// planned path, and how far it stays from obstacles beside it.
//
// Moving obstacles are predicted with their velocity. An arc is not admissible
// either if the robot, braking after the reaction time, would touch one before
// it is stationary, or if one could reach it by then after a change of
// direction (the separation distance of ISO 13855 for people near machines):
// until the robot is stationary at t, an obstacle may be up to `walking_speed`
// t away from where it is now.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_DYNAMIC_WINDOW_H_
#define CARTOGRAPHER_EXT_NAVIGATION_DYNAMIC_WINDOW_H_

#include <vector>

#include "Eigen/Core"
#include "absl/types/optional.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/navigation/local_obstacles.h"
#include "cartographer_ext/navigation/moving_obstacles.h"
#include "cartographer_ext/navigation/robot.h"

namespace cartographer_ext {
namespace navigation {

struct DynamicWindowOptions {
  double control_period = 0.1;  // seconds
  double horizon = 2.;          // seconds that an arc is looked at
  int linear_samples = 6;
  int angular_samples = 15;
  double heading_weight = 1.6;   // alpha
  double distance_weight = 0.2;  // beta
  double velocity_weight = 1.;   // gamma
  double path_weight = 1.2;      // delta
  double margin_weight = 0.3;    // epsilon
  // Kept free around the footprint, metres: from stationary and moving
  // obstacles.
  double margin = 0.05;
  double moving_margin = 0.2;
  // How a person may move while the robot brakes.
  double walking_speed = 1.;   // m/s, at least
  double reach_margin = 0.05;  // metres, of position and radius
  // Distances at which the terms saturate, metres.
  double distance_cap = 1.5;
  double path_cap = 0.6;
  double margin_cap = 0.35;
};

// What an arc is judged by. Poses and points are in the map frame.
struct DynamicWindowInput {
  Pose2 pose;                         // (map <- robot)
  Velocity current;                   // measured
  double max_speed = 0.;              // m/s, of this period
  Eigen::Vector2d target;             // a point of the path ahead
  std::vector<Eigen::Vector2d> path;  // ahead, one point every decimetre or so
  const LocalObstacles* obstacles = nullptr;
  std::vector<MovingDisc> moving;
};

struct VelocityWindow {
  double min_linear = 0., max_linear = 0.;
  double min_angular = 0., max_angular = 0.;
};

struct EvaluatedVelocity {
  Velocity velocity;
  bool admissible = false;
  double free_length = 0.;  // metres of arc until contact, within the horizon
  double margin = 0.;       // metres, least distance from the outline
  double score = 0.;        // G, of admissible ones
};

class DynamicWindow {
 public:
  DynamicWindow(const RobotLimits& robot, const DynamicWindowOptions& options);

  // Eq. 15, with the limits of the robot; `max_speed` as in the input.
  VelocityWindow WindowAround(const Velocity& current, double max_speed) const;

  // Eq. 14 and the terms of eq. 13.
  EvaluatedVelocity Evaluate(const DynamicWindowInput& input,
                             const Velocity& velocity) const;

  // The best admissible velocity. Empty if there is none; the robot then has to
  // brake.
  absl::optional<EvaluatedVelocity> Choose(
      const DynamicWindowInput& input) const;

 private:
  // Whether the robot, braking, would touch something that moves.
  bool MeetsMoving(const DynamicWindowInput& input,
                   const Velocity& velocity) const;
  bool TouchesMoving(const std::vector<MovingDisc>& moving, const Pose2& pose,
                     double seconds) const;
  // Whether one of them could touch the robot, whatever its direction.
  bool IsWithinReach(const std::vector<MovingDisc>& moving, const Pose2& pose,
                     double seconds) const;

  const RobotLimits robot_;
  const DynamicWindowOptions options_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_DYNAMIC_WINDOW_H_
