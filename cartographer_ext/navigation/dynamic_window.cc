// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/dynamic_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/navigation/speed_limiter.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kMaxStride = 0.05;        // metres between two looks at an arc
constexpr double kMaxTurn = 0.1;           // radians
constexpr double kTimeStep = 0.1;          // seconds, for what moves
constexpr double kNearer = 0.002;          // metres: less is rounding
constexpr double kStationarySpeed = 1e-3;  // m/s
constexpr double kCreepingSpeed = 0.02;    // m/s
constexpr double kHeadingSeconds = 0.8;    // ahead, where the heading is judged

double DistanceToPath(const std::vector<Eigen::Vector2d>& path,
                      const Eigen::Vector2d& point) {
  double squared = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& other : path) {
    squared = std::min(squared, (other - point).squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace

DynamicWindow::DynamicWindow(const RobotLimits& robot,
                             const DynamicWindowOptions& options)
    : robot_(robot), options_(options) {
  CHECK_GT(robot.deceleration, 0.);
  CHECK_GT(robot.turn_acceleration, 0.);
  CHECK_GE(options.linear_samples, 2);
  CHECK_GE(options.angular_samples, 3);
}

VelocityWindow DynamicWindow::WindowAround(const Velocity& current,
                                           const double max_speed) const {
  const double period = options_.control_period;
  VelocityWindow window;
  const double highest = std::max(0., std::min(robot_.max_speed, max_speed));
  window.max_linear =
      std::min(highest, current.linear + robot_.acceleration * period);
  window.min_linear =
      std::max(0., current.linear - robot_.deceleration * period);
  // A robot that is too fast (or rolls backwards) brakes with its largest
  // deceleration.
  window.max_linear = std::max(window.max_linear, 0.);
  window.min_linear = std::min(window.min_linear, window.max_linear);
  const double change = robot_.turn_acceleration * period;
  const double rate = robot_.max_turn_rate;
  const double angular = std::max(-rate, std::min(rate, current.angular));
  window.max_angular = std::min(rate, angular + change);
  window.min_angular = std::max(-rate, angular - change);
  return window;
}

bool DynamicWindow::TouchesMoving(const std::vector<MovingDisc>& moving,
                                  const Pose2& pose,
                                  const double seconds) const {
  for (const MovingDisc& disc : moving) {
    if (robot_.footprint.Distance(pose, disc.At(seconds)) <
        disc.radius + options_.moving_margin) {
      return true;
    }
  }
  return false;
}

bool DynamicWindow::IsWithinReach(const std::vector<MovingDisc>& moving,
                                  const Pose2& pose,
                                  const double seconds) const {
  for (const MovingDisc& disc : moving) {
    const double reach =
        seconds * std::max(options_.walking_speed, disc.velocity.norm());
    if (robot_.footprint.Distance(pose, disc.position) <
        disc.radius + reach + options_.reach_margin) {
      return true;
    }
  }
  return false;
}

bool DynamicWindow::MeetsMoving(const DynamicWindowInput& input,
                                const Velocity& velocity) const {
  if (input.moving.empty()) return false;
  const double reaction = robot_.reaction_seconds;
  const double braking =
      std::max(std::abs(velocity.linear) / robot_.deceleration,
               std::abs(velocity.angular) / robot_.turn_acceleration);
  if (braking == 0.) return false;
  const double end = reaction + braking;
  for (double time = 0.; time < end + kTimeStep; time += kTimeStep) {
    const double now = std::min(time, end);
    // Fraction of the braking that is over. The robot stays on its arc.
    const double done = std::max(0., now - reaction) / braking;
    const double seconds =
        std::min(now, reaction) + braking * (done - 0.5 * done * done);
    const Pose2 pose = input.pose * ArcPose(velocity.linear * seconds,
                                            velocity.angular * seconds);
    if (TouchesMoving(input.moving, pose, now) ||
        IsWithinReach(input.moving, pose, now)) {
      return true;
    }
  }
  return false;
}

EvaluatedVelocity DynamicWindow::Evaluate(const DynamicWindowInput& input,
                                          const Velocity& velocity) const {
  EvaluatedVelocity result;
  result.velocity = velocity;
  const double v = velocity.linear, w = velocity.angular;
  // Far enough to decide whether the robot can stop.
  const double horizon =
      std::max(options_.horizon,
               robot_.reaction_seconds + std::abs(v) / robot_.deceleration);
  const int steps = std::max(
      2,
      static_cast<int>(std::ceil(horizon * std::max(std::abs(v) / kMaxStride,
                                                    std::abs(w) / kMaxTurn))));
  const double step = horizon / steps;
  double free_seconds = horizon;   // of stationary obstacles
  double unmet_seconds = horizon;  // of what moves, too
  double path_sum = 0.;
  int path_count = 0;
  double margin = options_.margin_cap;
  const bool stationary = std::abs(v) < kStationarySpeed;
  const double now = input.obstacles->Clearance(robot_.footprint, input.pose);
  for (int i = 1; i <= steps; ++i) {
    const double seconds = i * step;
    const Pose2 pose = input.pose * ArcPose(v * seconds, w * seconds);
    const double clearance = input.obstacles->Clearance(robot_.footprint, pose);
    // A robot that is too near already may leave, and turn or drive past where
    // that brings nothing nearer.
    if (clearance < std::min(options_.margin, now - kNearer)) {
      free_seconds = (i - 1) * step;
      unmet_seconds = std::min(unmet_seconds, free_seconds);
      break;
    }
    margin = std::min(margin, clearance);
    if (unmet_seconds == horizon && !input.moving.empty() &&
        TouchesMoving(input.moving, pose, seconds)) {
      unmet_seconds = (i - 1) * step;
    }
    if (i % 3 == 0 || i == steps) {
      path_sum += std::min(options_.path_cap,
                           DistanceToPath(input.path, pose.translation()));
      ++path_count;
    }
  }
  result.free_length = std::abs(v) * free_seconds;
  result.margin = margin;
  // Eq. 14.
  const double free_angle = std::abs(w) * free_seconds;
  result.admissible =
      (stationary ||
       std::abs(v) <= SafeSpeed(result.free_length, robot_.reaction_seconds,
                                robot_.deceleration)) &&
      (free_seconds == horizon ||
       std::abs(w) <= std::sqrt(2. * free_angle * robot_.turn_acceleration)) &&
      !MeetsMoving(input, velocity);
  if (!result.admissible) return result;

  // Eq. 13.
  const double to_target = (input.target - input.pose.translation()).norm();
  const double seconds =
      stationary ? kHeadingSeconds
                 : std::min(kHeadingSeconds, 0.5 * to_target / std::abs(v));
  const Pose2 ahead = input.pose * ArcPose(v * seconds, w * seconds);
  const Eigen::Vector2d direction = input.target - ahead.translation();
  const double heading_error = std::abs(
      NormalizeAngle(std::atan2(direction.y(), direction.x()) - ahead.theta));
  const double path_error =
      path_count == 0 ? 0. : path_sum / path_count / options_.path_cap;
  const double distance_term =
      std::min(1., std::abs(v) * unmet_seconds / options_.distance_cap);
  result.score =
      options_.heading_weight * (1. - heading_error / kPi) +
      options_.distance_weight *
          (unmet_seconds == horizon ? 1. : distance_term) +
      options_.velocity_weight * std::abs(v) / robot_.max_speed +
      options_.path_weight * (1. - path_error) +
      options_.margin_weight * std::max(0., margin / options_.margin_cap);
  return result;
}

absl::optional<EvaluatedVelocity> DynamicWindow::Choose(
    const DynamicWindowInput& input) const {
  const VelocityWindow window = WindowAround(input.current, input.max_speed);
  absl::optional<EvaluatedVelocity> best;
  bool best_moves = false;
  const auto consider = [&](const double linear, const double angular) {
    const EvaluatedVelocity evaluated = Evaluate(input, {linear, angular});
    if (!evaluated.admissible) return;
    // Where every motion leads nearer to an obstacle, zero velocity would have
    // the greatest objective for ever. It is chosen only if no motion is
    // admissible.
    const bool moves = linear >= kCreepingSpeed;
    if (!best.has_value() || (moves && !best_moves) ||
        (moves == best_moves && evaluated.score > best->score)) {
      best = evaluated;
      best_moves = moves;
    }
  };
  for (int i = 0; i != options_.linear_samples; ++i) {
    const double linear =
        window.max_linear - (window.max_linear - window.min_linear) * i /
                                (options_.linear_samples - 1);
    for (int j = 0; j != options_.angular_samples; ++j) {
      consider(linear,
               window.min_angular + (window.max_angular - window.min_angular) *
                                        j / (options_.angular_samples - 1));
    }
    if (window.min_angular < 0. && window.max_angular > 0.) {
      consider(linear, 0.);
    }
  }
  return best;
}

}  // namespace navigation
}  // namespace cartographer_ext
