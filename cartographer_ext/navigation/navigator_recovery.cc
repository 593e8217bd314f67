// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the navigator does where it makes no progress.
#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_format.h"
#include "cartographer_ext/navigation/field_of_view.h"
#include "cartographer_ext/navigation/navigator.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kProgress = 0.25;    // metres
constexpr double kBackUpSpeed = 0.1;  // m/s
constexpr double kBackUpSeconds = 3.;
constexpr double kTurnSeconds = 10.;  // once round at 0.8 rad/s
constexpr double kWaitSeconds = 5.;
constexpr double kTrailWidth = 0.1;   // metres: so far it is still free
constexpr double kForgetRadius = 3.;  // metres

// Giving way: after so long of standing, since the last progress, beside
// something that the map does not show, so near to the outline, where somebody
// was seen to walk.
constexpr double kPatienceSeconds = 4.;
constexpr double kNear = 0.6;             // metres
constexpr double kSomebodySeconds = 30.;  // since somebody was seen to move
constexpr double kDetourSpeed = 0.2;      // m/s
constexpr double kDetourSeconds = 12.;    // for turning and driving, at most
constexpr double kLetPassSeconds = 6.;    // at the wider place
constexpr double kDetourAligned = 0.15;   // radians
constexpr double kDetourArrived = 0.05;   // metres
constexpr int kMaxDetours = 4;            // without progress between
// A robot that is touched stands still; but not for ever, by what never goes.
constexpr double kTouchSeconds = 20.;
constexpr int kTouchEchoes = 3;  // fewer are errors of the laser

}  // namespace

bool Navigator::CameFromBehind(const Pose2& pose) const {
  const Eigen::Vector2d behind =
      pose * Eigen::Vector2d(-kBackUpSpeed * kBackUpSeconds, 0.);
  for (const Eigen::Vector2d& place : trail_) {
    if ((place - behind).norm() <= kTrailWidth) return true;
  }
  return false;
}

void Navigator::WatchProgress(const NavigatorStep& step) {
  const Eigen::Vector2d place = step.map_from_robot.translation();
  if (!has_progress_ || (step.time >= recovery_end_ && !detour_.has_value() &&
                         (place - progress_place_).norm() > kProgress)) {
    has_progress_ = true;
    progress_place_ = place;
    progress_time_ = trying_since_ = step.time;
    recovery_count_ = 0;
    detours_ = 0;
    blocked_seconds_ = 0.;
    return;
  }
  const double idle = step.time - progress_time_;
  // What a recovery moves is no progress.
  if (step.time < recovery_end_ || detour_.has_value()) progress_place_ = place;
  if (idle > options_.give_up_seconds) {
    FinishGoal(false,
               absl::StrFormat("no progress for %.0f s: %s", idle, message_),
               step.time);
    return;
  }
  // Each recovery is given time to show what it was good for.
  if (step.time < recovery_end_ || waits_for_somebody_ || detour_.has_value()) {
    trying_since_ = step.time;
  }
  if (step.time - trying_since_ < options_.stuck_seconds) return;
  recovery_ = static_cast<Recovery>(recovery_count_ % 4);
  ++recovery_count_;
  ++recoveries_;
  recovery_begin_ = trying_since_ = step.time;
  switch (recovery_) {
    case Recovery::kTurn:
      looked_ = step.time;
      recovery_end_ = step.time + kTurnSeconds;
      break;
    case Recovery::kForget:
      layer_.Clear(place, kForgetRadius, looked_);
      planned_ = -1e9;
      break;
    case Recovery::kBackUp:
      recovery_end_ = step.time + kBackUpSeconds;
      break;
    case Recovery::kWait:
      recovery_end_ = step.time + kWaitSeconds;
      break;
  }
}

Velocity Navigator::Recover(const NavigatorStep& step) {
  state_ = DriveState::kRecovering;
  planned_ = -1e9;  // a new path afterwards
  if (recovery_ == Recovery::kWait) {
    message_ = "no progress: waiting";
    return Velocity();
  }
  DynamicWindowInput input;
  const LocalObstacles obstacles(*costmap_, &layer_, {},
                                 step.map_from_robot.translation(),
                                 options_.window_half_width);
  input.pose = step.map_from_robot;
  input.current = step.velocity;
  input.target = input.pose.translation();
  input.obstacles = &obstacles;
  input.moving = moving_.Moving(step.time);
  Velocity wish;
  if (recovery_ == Recovery::kTurn) {
    message_ = "no progress: turning";
    wish.angular = options_.robot.max_turn_rate;
  } else if (step.time == recovery_begin_ && !CameFromBehind(input.pose)) {
    recovery_end_ = step.time;
    return Velocity();
  } else {
    message_ = "no progress: backing up";
    wish.linear = -std::min(kBackUpSpeed, options_.robot.max_reverse_speed);
  }
  return Admit(input, Reach(step.velocity, wish));
}

double Navigator::NearestStranger(const NavigatorStep& step) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& echo : echoes_now_) {
    const double gap = options_.robot.footprint.Distance(Pose2(), echo);
    if (gap < nearest && !layer_.IsWall(step.map_from_robot * echo)) {
      nearest = gap;
    }
  }
  return nearest;
}

bool Navigator::IsTouched(const NavigatorStep& step) {
  int touching = 0;
  for (const Eigen::Vector2d& echo : echoes_now_) {
    touching += options_.robot.footprint.Distance(Pose2(), echo) <
                    options_.stop_margin &&
                !layer_.IsWall(step.map_from_robot * echo);
  }
  if (touching < kTouchEchoes) {
    touched_since_ = step.time;
    return false;
  }
  return step.time - touched_since_ < kTouchSeconds;
}

bool Navigator::GivesWay(const NavigatorStep& step) {
  const bool was_under_way = detour_.has_value();
  if (was_under_way && step.time >= detour_->end) {
    detour_.reset();
    trying_since_ = step.time;
    blocked_seconds_ = 0.;
    planned_ = -1e9;
    return false;
  }
  if (was_under_way) return true;
  if (detours_ >= kMaxDetours || blocked_seconds_ < kPatienceSeconds ||
      step.time - somebody_near_ > kSomebodySeconds ||
      NearestStranger(step) > kNear) {
    return false;
  }
  blocked_seconds_ = 0.;
  const LocalObstacles obstacles(*costmap_, &layer_, MapEchoes(step),
                                 step.map_from_robot.translation(),
                                 options_.window_half_width);
  const absl::optional<WiderPlace> place = obstacles.FindWiderPlace(
      options_.robot.footprint, options_.window.margin, step.map_from_robot);
  if (!place.has_value()) return false;
  ++detours_;
  ++times_given_way_;
  detour_ = Detour();
  detour_->place = place->position;
  detour_->end = step.time + kDetourSeconds;
  // Backwards where the laser sees where that leads and it is less of a turn.
  const FieldOfView view(scan_.laser, scan_.echoes, scan_.free_ends);
  const Eigen::Vector2d target =
      step.map_from_robot.Inverse() * place->position;
  detour_->backwards = target.x() < 0. && view.Contains({-1., 0.});
  return true;
}

Velocity Navigator::GiveWay(const NavigatorStep& step) {
  state_ = DriveState::kRecovering;
  message_ = "giving way";
  const LocalObstacles obstacles(*costmap_, &layer_, MapEchoes(step),
                                 step.map_from_robot.translation(),
                                 options_.window_half_width);
  DynamicWindowInput input;
  input.pose = step.map_from_robot;
  input.current = step.velocity;
  input.target = detour_->place;
  input.obstacles = &obstacles;
  input.moving = moving_.Moving(step.time);
  const Eigen::Vector2d to_place =
      detour_->place - step.map_from_robot.translation();
  if (!detour_->arrived && to_place.norm() < kDetourArrived) {
    detour_->arrived = true;
    detour_->end = step.time + kLetPassSeconds;
  }
  if (detour_->arrived) return Velocity();
  const double direction = detour_->backwards ? -1. : 1.;
  const double error = NormalizeAngle(
      std::atan2(direction * to_place.y(), direction * to_place.x()) -
      step.map_from_robot.theta);
  Velocity wish;
  const double speed = std::min(
      kDetourSpeed, detour_->backwards ? options_.robot.max_reverse_speed
                                       : options_.robot.max_speed);
  if (std::abs(error) < kDetourAligned) {
    wish.linear = direction * std::min(speed, 0.05 + to_place.norm());
  }
  wish.angular = std::max(-0.6, std::min(0.6, 1.5 * error));
  return Admit(input, Reach(step.velocity, wish));
}

}  // namespace navigation
}  // namespace cartographer_ext
