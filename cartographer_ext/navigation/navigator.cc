// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/navigator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/navigation/field_of_view.h"
#include "cartographer_ext/navigation/speed_limiter.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kTurnFrom = 0.9;   // radians off the path: turn on the spot
constexpr double kTurnUntil = 0.2;  // radians
constexpr double kSlowSpeed = 0.1;  // m/s: turns on the spot below it
constexpr double kBendSpeed = 0.3;  // m/s, at least, where the path bends
constexpr double kAhead = 0.3;      // radians: near enough to drive at a goal
constexpr double kStationarySpeed = 0.02;  // m/s, measured
constexpr double kStationaryTurn = 0.1;    // rad/s
constexpr double kLookahead = 0.5;         // metres, and what one second covers
constexpr double kPathAhead = 3.;          // metres of path the window looks at
constexpr double kReplanSeconds = 0.3;  // soonest after a failure while driving
constexpr double kKeepPathDistance = 0.4;  // metres
// A new path replaces the present one if it is cheaper by at least this many
// metres of free path, about the cost of turning round and back again.
constexpr double kKeepPathMetres = 3.;
constexpr double kLongDetour = 5.;             // metres more than expected
constexpr double kDetourLookSeconds = 10.;     // what is seen then is kept
constexpr double kDetourMemorySeconds = 600.;  // of what made it necessary
constexpr double kNearby =
    1.5;  // metres: somebody this near may block the robot
constexpr double kPersonMargin = 0.2;   // metres around what moves
constexpr double kTrailLength = 1.;     // metres
constexpr double kTrailSpacing = 0.05;  // metres

bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) &&
         std::isfinite(pose.theta);
}

double BearingError(const Pose2& pose, const Eigen::Vector2d& target) {
  const Eigen::Vector2d direction = target - pose.translation();
  return NormalizeAngle(std::atan2(direction.y(), direction.x()) - pose.theta);
}

// Whether a point is in one of the discs or so near to one.
bool IsAtAny(const std::vector<MovingDisc>& discs, const Eigen::Vector2d& point,
             const double margin) {
  for (const MovingDisc& disc : discs) {
    if ((point - disc.position).norm() < disc.radius + margin) {
      return true;
    }
  }
  return false;
}

}  // namespace

const char* ToString(const DriveState state) {
  switch (state) {
    case DriveState::kDriving:
      return "driving";
    case DriveState::kTurning:
      return "turning";
    case DriveState::kObstructed:
      return "obstructed";
    case DriveState::kRecovering:
      return "recovering";
    case DriveState::kLost:
      return "lost";
    case DriveState::kBlind:
      return "blind";
    case DriveState::kFinished:
      return "finished";
  }
  return "";
}

Navigator::Navigator(const Costmap* const costmap,
                     const NavigatorOptions& options,
                     const std::vector<Eigen::Vector2d>& goals)
    : costmap_(costmap),
      options_(options),
      goals_(goals),
      layer_(costmap, options.obstacles),
      moving_(options.moving),
      monitor_(options.localization),
      planner_(costmap),
      window_(options.robot, options.window) {}

void Navigator::AddScan(const NavigatorScan& scan) {
  scan_ = scan;
  has_scan_ = true;
  monitor_.AddScan(*costmap_, scan.echoes, scan.map_from_robot,
                   scan.odometry_step, scan.time);
  // With a wrong pose, every wall would be marked as an obstacle.
  if (!IsFinite(scan.map_from_robot) || monitor_.IsLost(scan.time)) return;
  ScanInMap in_map;
  in_map.time = scan.time;
  in_map.laser = scan.map_from_robot * scan.laser;
  std::vector<MovingObstacles::Echo> unexplained;
  const std::vector<MovingDisc> people = moving_.Moving(scan.time);
  if (IsAtAny(people, scan.map_from_robot.translation(), kNearby)) {
    somebody_near_ = scan.time;
  }
  for (const Eigen::Vector2d& echo : scan.echoes) {
    if (!echo.allFinite()) continue;
    const Eigen::Vector2d point = scan.map_from_robot * echo;
    // Moving obstacles are left to the dynamic window: a path around them would
    // be wrong a moment later.
    (IsAtAny(people, point, kPersonMargin) ? in_map.free_ends : in_map.echoes)
        .push_back(point);
    if ((point - in_map.laser).norm() <= options_.obstacles.range &&
        !layer_.IsWall(point)) {
      unexplained.push_back({point, layer_.MarkAge(point, scan.time)});
    }
  }
  for (const Eigen::Vector2d& end : scan.free_ends) {
    if (end.allFinite()) in_map.free_ends.push_back(scan.map_from_robot * end);
  }
  layer_.Update(in_map);
  const FieldOfView view(scan.laser, scan.echoes, scan.free_ends);
  const Pose2 robot_from_map = scan.map_from_robot.Inverse();
  moving_.Update(unexplained, scan.time, [&](const Eigen::Vector2d& point) {
    return view.Contains(robot_from_map * point);
  });
}

Velocity Navigator::Stop(const DriveState state, const std::string& message) {
  state_ = state;
  message_ = message;
  turning_ = false;
  return Velocity();
}

bool Navigator::SensesAreGood(const NavigatorStep& step) {
  if (!has_scan_ || !(step.time - scan_.time <= options_.max_scan_age)) {
    Stop(DriveState::kBlind, "stopped: no recent scan");
    return false;
  }
  int echoes = 0;
  for (const Eigen::Vector2d& echo : scan_.echoes) echoes += echo.allFinite();
  if (echoes < options_.min_echoes) {
    Stop(DriveState::kBlind, "stopped: the laser sees nothing");
    return false;
  }
  if (!IsFinite(step.map_from_robot)) {
    Stop(DriveState::kLost, "stopped: the pose is not a number");
    return false;
  }
  if (monitor_.IsLost(step.time)) {
    Stop(DriveState::kLost,
         absl::StrCat("stopped, lost: ", monitor_.Reason(step.time)));
    return false;
  }
  return true;
}

void Navigator::FinishGoal(const bool reached, const std::string& reason,
                           const double time) {
  results_.push_back({goals_[goal_], reached, reason, time});
  ++goal_;
  plan_ = Plan();
  tracker_ = PathTracker();
  planned_ = -1e9;
  has_progress_ = false;
  recovery_count_ = 0;
  passing_place_.reset();
  passing_places_ = 0;
  blocked_seconds_ = 0.;
}

bool Navigator::KeepsPath(const Plan& plan,
                          const Eigen::Vector2d& place) const {
  if (!plan.found() || !plan_.found() || tracker_.empty()) return false;
  std::vector<Eigen::Vector2d> rest =
      tracker_.PointsAhead(std::numeric_limits<double>::infinity());
  if ((rest.front() - place).norm() > kKeepPathDistance) return false;
  return planner_.Cost(rest) <= planner_.Cost(plan.points) + kKeepPathMetres;
}

bool Navigator::FollowsPlan(const NavigatorStep& step) {
  const bool due = step.time - planned_ >= options_.plan_period ||
                   (!plan_.found() && step.time - planned_ >= kReplanSeconds);
  if (due) {
    const Eigen::Vector2d place = step.map_from_robot.translation();
    Plan plan = planner_.MakePlan(place, goals_[goal_], &layer_);
    ++plans_;
    planned_ = step.time;
    if (!plan.found()) {
      layer_.LetGo();
    } else if (plan_.found() &&
               plan.length > tracker_.Remaining() + kLongDetour) {
      detour_seen_ = step.time;
    }
    if (step.time - detour_seen_ <= kDetourLookSeconds) {
      layer_.Keep(place, options_.obstacles.range,
                  step.time + kDetourMemorySeconds);
    }
    if (KeepsPath(plan, place)) return true;
    plan_ = std::move(plan);
    tracker_ = plan_.found() ? PathTracker(plan_.points) : PathTracker();
    if (IsFinal(plan_.outcome)) {
      const std::string reason = ToString(plan_.outcome);
      FinishGoal(false, reason, step.time);
      Stop(DriveState::kObstructed, absl::StrCat("goal given up: ", reason));
      return false;
    }
  }
  if (!plan_.found()) {
    Stop(DriveState::kObstructed,
         absl::StrCat("waiting: ", ToString(plan_.outcome)));
    return false;
  }
  return true;
}

void Navigator::ExplainBraking(const DynamicWindowInput& input) {
  DynamicWindowInput alone = input;
  alone.moving.clear();
  waits_for_somebody_ =
      !input.moving.empty() && window_.Choose(alone).has_value();
  message_ = waits_for_somebody_ ? "waiting: somebody passes by"
                                 : "braking: no admissible velocity";
}

Velocity Navigator::Admit(const DynamicWindowInput& input,
                          const Velocity& command) {
  if (window_.Evaluate(input, command).admissible) return command;
  ExplainBraking(input);
  return Velocity();
}

Velocity Navigator::Reach(const Velocity& current, const Velocity& wish) const {
  const double period = options_.window.control_period;
  const RobotLimits& robot = options_.robot;
  const auto toward = [](const double from, const double to,
                         const double step) {
    return from + std::max(-step, std::min(step, to - from));
  };
  const bool braking = std::abs(wish.linear) < std::abs(current.linear);
  return {
      toward(current.linear, wish.linear,
             period * (braking ? robot.deceleration : robot.acceleration)),
      toward(current.angular, wish.angular, period * robot.turn_acceleration)};
}

DynamicWindowInput Navigator::WindowInput(
    const NavigatorStep& step, const Eigen::Vector2d& target,
    const LocalObstacles* const obstacles) const {
  DynamicWindowInput input;
  input.pose = step.map_from_robot;
  input.current = step.velocity;
  input.target = target;
  input.obstacles = obstacles;
  input.moving = moving_.Moving(step.time);
  return input;
}

DynamicWindowInput Navigator::PathInput(
    const NavigatorStep& step, const LocalObstacles* const obstacles) const {
  DynamicWindowInput input = WindowInput(
      step, tracker_.Ahead(kLookahead + std::abs(step.velocity.linear)),
      obstacles);
  const double to_goal =
      (goals_[goal_] - step.map_from_robot.translation()).norm();
  input.max_speed =
      std::min(options_.robot.max_speed,
               std::max(0.08, std::sqrt(2. * 0.5 * options_.robot.acceleration *
                                        std::max(0., to_goal - 0.05))));
  input.path = tracker_.PointsAhead(kPathAhead);
  return input;
}

Velocity Navigator::Approach(const NavigatorStep& step,
                             const DynamicWindowInput& input) {
  const Eigen::Vector2d goal = goals_[goal_];
  const double distance = (goal - step.map_from_robot.translation()).norm();
  const double error = BearingError(step.map_from_robot, goal);
  Velocity wish;
  if (std::abs(error) < kAhead) {
    wish.linear = std::max(0.05, std::min(input.max_speed, 0.8 * distance));
  }
  wish.angular = std::max(-0.6, std::min(0.6, 1.5 * error));
  return Admit(input, Reach(step.velocity, wish));
}

bool Navigator::IsAtGoal(const NavigatorStep& step) const {
  const double to_goal =
      (goals_[goal_] - step.map_from_robot.translation()).norm();
  if (!(to_goal <= options_.goal_tolerance)) return false;
  // A robot that does not move has stopped by itself, or because of an obstacle
  // beside the goal.
  return to_goal <= options_.goal_aim ||
         std::abs(step.velocity.linear) < kStationarySpeed ||
         std::abs(BearingError(step.map_from_robot, goals_[goal_])) > kAhead;
}

LocalObstacles Navigator::ObstaclesAround(const NavigatorStep& step) const {
  std::vector<Eigen::Vector2d> echoes;  // map frame
  echoes.reserve(echoes_now_.size());
  for (const Eigen::Vector2d& echo : echoes_now_) {
    echoes.push_back(step.map_from_robot * echo);
  }
  return LocalObstacles(*costmap_, &layer_, echoes,
                        step.map_from_robot.translation(),
                        options_.window_half_width);
}

Velocity Navigator::Follow(const NavigatorStep& step) {
  const LocalObstacles obstacles = ObstaclesAround(step);
  DynamicWindowInput input = PathInput(step, &obstacles);
  const double to_goal =
      (goals_[goal_] - step.map_from_robot.translation()).norm();
  state_ = DriveState::kDriving;
  message_ = absl::StrFormat("driving to goal %d", goal_ + 1);
  if (to_goal <= options_.approach_distance) return Approach(step, input);

  const double error = BearingError(step.map_from_robot, input.target);
  // Slower where the path bends.
  input.max_speed = std::max(
      std::min(input.max_speed, kBendSpeed),
      input.max_speed * (1. - std::min(1., std::abs(error) / kTurnFrom)));
  const bool slow = std::abs(step.velocity.linear) < kSlowSpeed;
  turning_ = std::abs(error) > (turning_ ? kTurnUntil : kTurnFrom);
  if (turning_) {
    state_ = DriveState::kTurning;
    message_ = "turning towards the path";
    Velocity wish;
    // Slows down so as not to overshoot.
    const double rate =
        std::min(options_.robot.max_turn_rate,
                 std::sqrt(options_.robot.turn_acceleration * std::abs(error)));
    if (slow) wish.angular = error > 0. ? rate : -rate;
    return Admit(input, Reach(step.velocity, wish));
  }
  const absl::optional<EvaluatedVelocity> best = window_.Choose(input);
  if (!best.has_value()) {
    planned_ =
        std::min(planned_, step.time - options_.plan_period + kReplanSeconds);
    ExplainBraking(input);
    return Velocity();
  }
  return best->velocity;
}

Velocity Navigator::Step(const NavigatorStep& step) {
  echoes_now_.clear();
  const Pose2 now_from_scan = step.motion_since_scan.Inverse();
  for (const Eigen::Vector2d& echo : scan_.echoes) {
    if (echo.allFinite()) echoes_now_.push_back(now_from_scan * echo);
  }
  if (finished()) return Stop(DriveState::kFinished, "all goals done");
  if (!SensesAreGood(step)) {
    planned_ = -1e9;
    has_progress_ = false;
    return Velocity();
  }
  if (IsAtGoal(step)) {
    if (std::abs(step.velocity.linear) < kStationarySpeed) {
      FinishGoal(true, "", step.time);
      if (finished()) return Stop(DriveState::kFinished, "all goals done");
    }
    return Stop(DriveState::kDriving, "stopping at the goal");
  }
  const Eigen::Vector2d place = step.map_from_robot.translation();
  if (trail_.empty() || (trail_.back() - place).norm() >= kTrailSpacing) {
    trail_.push_back(place);
    if (trail_.size() * kTrailSpacing > kTrailLength) trail_.pop_front();
  }
  WatchProgress(step);
  waits_for_somebody_ = false;
  if (finished()) return Stop(DriveState::kFinished, "all goals done");
  Velocity command;
  if (step.time < recovery_end_ && recovery_count_ > 0) {
    command = Recover(step);
  } else if (IsGivingWay(step)) {
    command = GiveWay(step);
  } else if (FollowsPlan(step)) {
    tracker_.Advance(step.map_from_robot.translation());
    command = Follow(step);
  }
  if (IsTouched(step)) {
    message_ = "waiting: somebody touches the robot";
    command = Velocity();
  }
  command =
      LimitSpeed(echoes_now_, options_.robot, options_.stop_margin, command);
  const double elapsed = std::min(step.time - stepped_, 1.);
  stepped_ = step.time;
  if (!passing_place_.has_value() &&
      std::abs(command.linear) < kStationarySpeed &&
      std::abs(command.angular) < kStationaryTurn) {
    blocked_seconds_ += elapsed;
  }
  return command;
}

}  // namespace navigation
}  // namespace cartographer_ext
