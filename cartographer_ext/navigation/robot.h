// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Velocity and limits of a robot, shared by the controller and the simulator.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_ROBOT_H_
#define CARTOGRAPHER_EXT_NAVIGATION_ROBOT_H_

#include "cartographer_ext/navigation/footprint.h"

namespace cartographer_ext {
namespace navigation {

// Of the origin of the robot frame, along x and counter-clockwise.
struct Velocity {
  double linear = 0.;   // m/s, negative backwards
  double angular = 0.;  // rad/s
};

struct RobotLimits {
  Footprint footprint = Footprint::Disc(0.25);
  double max_speed = 0.7;          // m/s
  double max_reverse_speed = 0.2;  // m/s
  double max_turn_rate = 0.8;      // rad/s
  double acceleration = 0.5;       // m/s^2
  double deceleration = 1.;        // m/s^2
  double turn_acceleration = 1.5;  // rad/s^2
  // Seconds from an echo to the reaction of the wheels: age of the scan, one
  // control period, delay of the drive.
  double reaction_seconds = 0.3;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_ROBOT_H_
