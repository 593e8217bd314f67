// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/speed_limiter.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kStep = 0.02;             // metres along the arc
constexpr double kTurnStep = 0.05;         // radians on the spot
constexpr double kTurnAhead = 0.3;         // radians looked ahead on the spot
constexpr double kStationarySpeed = 1e-3;  // m/s: slower is turning on the spot

// Whether the footprint at `pose` is on an echo that it has come nearer to.
bool Meets(const std::vector<Eigen::Vector2d>& echoes,
           const Footprint& footprint, const double margin, const Pose2& pose) {
  for (const Footprint::Part& part : footprint.parts) {
    const Eigen::Vector2d center = pose * part.center;
    const double radius = part.radius + margin;
    for (const Eigen::Vector2d& echo : echoes) {
      const double squared = (echo - center).squaredNorm();
      if (squared < radius * radius &&
          squared < (echo - part.center).squaredNorm() - 1e-9) {
        return true;
      }
    }
  }
  return false;
}

std::vector<Eigen::Vector2d> Within(const std::vector<Eigen::Vector2d>& echoes,
                                    const double distance) {
  std::vector<Eigen::Vector2d> near;
  for (const Eigen::Vector2d& echo : echoes) {
    if (echo.allFinite() && echo.norm() <= distance) near.push_back(echo);
  }
  return near;
}

}  // namespace

double SafeSpeed(const double distance, const double reaction_seconds,
                 const double deceleration) {
  if (!(distance > 0.)) return 0.;
  const double t = reaction_seconds;
  return deceleration * (std::sqrt(t * t + 2. * distance / deceleration) - t);
}

double FreeArcLength(const std::vector<Eigen::Vector2d>& echoes,
                     const Footprint& footprint, const double margin,
                     const Velocity& command, const double limit) {
  const std::vector<Eigen::Vector2d> near =
      Within(echoes, limit + footprint.circumscribed_radius() + margin + kStep);
  if (near.empty()) return limit;
  const double direction = command.linear >= 0. ? 1. : -1.;
  const double curvature = command.angular / command.linear;
  for (double length = kStep; length < limit + kStep; length += kStep) {
    if (Meets(near, footprint, margin,
              ArcPose(direction * length, direction * length * curvature))) {
      return std::max(0., std::min(limit, length - kStep));
    }
  }
  return limit;
}

Velocity LimitSpeed(const std::vector<Eigen::Vector2d>& echoes,
                    const RobotLimits& robot, const double margin,
                    const Velocity& command) {
  if (!std::isfinite(command.linear) || !std::isfinite(command.angular)) {
    return Velocity();
  }
  const double speed = std::abs(command.linear);
  if (speed < kStationarySpeed) {
    const std::vector<Eigen::Vector2d> near =
        Within(echoes, robot.footprint.circumscribed_radius() + margin);
    const double direction = command.angular >= 0. ? 1. : -1.;
    for (double turn = kTurnStep; turn <= kTurnAhead; turn += kTurnStep) {
      if (Meets(near, robot.footprint, margin,
                Pose2(0., 0., direction * turn))) {
        return Velocity();
      }
    }
    return {0., command.angular};
  }
  const double needed = speed * robot.reaction_seconds +
                        speed * speed / (2. * robot.deceleration);
  const double free =
      FreeArcLength(echoes, robot.footprint, margin, command, needed + kStep);
  const double safe =
      SafeSpeed(free, robot.reaction_seconds, robot.deceleration);
  if (speed <= safe) return command;
  return {command.linear * safe / speed, command.angular * safe / speed};
}

}  // namespace navigation
}  // namespace cartographer_ext
