// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The last check of every command: a robot that moves on an arc must be able to
// stop before it reaches the nearest echo of the latest scan. Needs no map and
// no localisation, so it holds when these fail.
//
// With d the length of the arc that is free of echoes, t the reaction time and
// b the deceleration, the robot is safe while
//   v t + v^2 / (2 b) <= d,  that is  v <= b (sqrt(t^2 + 2 d / b) - t).
// Linear and angular speed are scaled together: the robot stays on the arc.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_SPEED_LIMITER_H_
#define CARTOGRAPHER_EXT_NAVIGATION_SPEED_LIMITER_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/navigation/robot.h"

namespace cartographer_ext {
namespace navigation {

// Largest speed from which the robot stops within `distance` metres; 0 for a
// distance that is not positive.
double SafeSpeed(double distance, double reaction_seconds, double deceleration);

// Metres along the arc of `command` until the footprint, grown by `margin`,
// meets an echo (robot frame), at most `limit`. Echoes that are inside already
// count only where the robot comes nearer to them.
double FreeArcLength(const std::vector<Eigen::Vector2d>& echoes,
                     const Footprint& footprint, double margin,
                     const Velocity& command, double limit);

// The command, or a slower one on the same arc. Turning on the spot is stopped
// where the outline would sweep over an echo.
Velocity LimitSpeed(const std::vector<Eigen::Vector2d>& echoes,
                    const RobotLimits& robot, double margin,
                    const Velocity& command);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_SPEED_LIMITER_H_
