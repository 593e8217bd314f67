// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the navigator does where it makes no progress.
#include <algorithm>
#include <cmath>

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
constexpr double kTrailWidth = 0.1;   // metres beside the trail that are free
constexpr double kForgetRadius = 3.;  // metres

// The robot gives way when it has been blocked for so long since the last
// progress, something that the map does not show is so near to its outline, and
// somebody was seen to walk near it not longer ago than this.
constexpr double kPatienceSeconds = 4.;
constexpr double kNear = 0.6;  // metres
constexpr double kSomebodySeconds = 30.;
constexpr double kPassingSpeed = 0.2;         // m/s
constexpr double kPassingDriveSeconds = 12.;  // turning and driving, at most
constexpr double kLetPassSeconds = 6.;        // of waiting at the passing place
constexpr double kPassingAligned = 0.15;      // radians
constexpr double kPassingPlaceReached = 0.05;  // metres
constexpr int kMaxPassingPlaces = 4;           // without progress between them
// A robot that is touched does not move for so long. What touches it for longer
// is no person who will step aside.
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
  if (!has_progress_ ||
      (step.time >= recovery_end_ && !passing_place_.has_value() &&
       (place - progress_place_).norm() > kProgress)) {
    has_progress_ = true;
    progress_place_ = place;
    progress_time_ = trying_since_ = step.time;
    recovery_count_ = 0;
    passing_places_ = 0;
    blocked_seconds_ = 0.;
    return;
  }
  const double idle = step.time - progress_time_;
  // Motion during a recovery does not count as progress.
  if (step.time < recovery_end_ || passing_place_.has_value())
    progress_place_ = place;
  if (idle > options_.give_up_seconds) {
    FinishGoal(false,
               absl::StrFormat("no progress for %.0f s: %s", idle, message_),
               step.time);
    return;
  }
  // The time restarts with each recovery, so that it can take effect.
  if (step.time < recovery_end_ || waits_for_somebody_ ||
      passing_place_.has_value()) {
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
  // The latest echoes are left to LimitSpeed.
  const LocalObstacles obstacles(*costmap_, &layer_, {},
                                 step.map_from_robot.translation(),
                                 options_.window_half_width);
  const DynamicWindowInput input =
      WindowInput(step, step.map_from_robot.translation(), &obstacles);
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

int Navigator::CountUnexplainedEchoes(const NavigatorStep& step,
                                      const double distance) const {
  int count = 0;
  for (const Eigen::Vector2d& echo : echoes_now_) {
    count += options_.robot.footprint.Distance(Pose2(), echo) < distance &&
             !layer_.IsWall(step.map_from_robot * echo);
  }
  return count;
}

bool Navigator::IsTouched(const NavigatorStep& step) {
  if (CountUnexplainedEchoes(step, options_.stop_margin) < kTouchEchoes) {
    touched_since_ = step.time;
    return false;
  }
  return step.time - touched_since_ < kTouchSeconds;
}

bool Navigator::IsGivingWay(const NavigatorStep& step) {
  if (passing_place_.has_value()) {
    if (step.time < passing_place_->end) return true;
    passing_place_.reset();
    trying_since_ = step.time;
    blocked_seconds_ = 0.;
    planned_ = -1e9;
    return false;
  }
  if (passing_places_ >= kMaxPassingPlaces ||
      blocked_seconds_ < kPatienceSeconds ||
      step.time - somebody_near_ > kSomebodySeconds ||
      CountUnexplainedEchoes(step, kNear) == 0) {
    return false;
  }
  blocked_seconds_ = 0.;
  const absl::optional<WiderPlace> place = ObstaclesAround(step).FindWiderPlace(
      options_.robot.footprint, options_.window.margin, step.map_from_robot);
  if (!place.has_value()) return false;
  ++passing_places_;
  ++times_given_way_;
  passing_place_ = PassingPlace();
  passing_place_->position = place->position;
  passing_place_->end = step.time + kPassingDriveSeconds;
  // Backwards if that is less of a turn and the laser sees what is behind.
  const FieldOfView view(scan_.laser, scan_.echoes, scan_.free_ends);
  const Eigen::Vector2d target =
      step.map_from_robot.Inverse() * place->position;
  passing_place_->backwards = target.x() < 0. && view.Contains({-1., 0.});
  return true;
}

Velocity Navigator::GiveWay(const NavigatorStep& step) {
  state_ = DriveState::kRecovering;
  message_ = "giving way";
  PassingPlace& place = *passing_place_;
  const Eigen::Vector2d to_place =
      place.position - step.map_from_robot.translation();
  if (!place.arrived && to_place.norm() < kPassingPlaceReached) {
    place.arrived = true;
    place.end = step.time + kLetPassSeconds;
  }
  if (place.arrived) return Velocity();
  const double direction = place.backwards ? -1. : 1.;
  const double error = NormalizeAngle(
      std::atan2(direction * to_place.y(), direction * to_place.x()) -
      step.map_from_robot.theta);
  Velocity wish;
  const double speed =
      std::min(kPassingSpeed, place.backwards ? options_.robot.max_reverse_speed
                                              : options_.robot.max_speed);
  if (std::abs(error) < kPassingAligned) {
    wish.linear = direction * std::min(speed, 0.05 + to_place.norm());
  }
  wish.angular = std::max(-0.6, std::min(0.6, 1.5 * error));
  const LocalObstacles obstacles = ObstaclesAround(step);
  return Admit(WindowInput(step, place.position, &obstacles),
               Reach(step.velocity, wish));
}

}  // namespace navigation
}  // namespace cartographer_ext
