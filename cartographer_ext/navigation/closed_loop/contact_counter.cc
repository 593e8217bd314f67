// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/contact_counter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cartographer_ext {
namespace navigation {
namespace {

using simulation::Disc;

// A slower robot counts as stationary: these are the last 10 and 33 ms of a
// stop.
constexpr double kMovingSpeed = 0.01;  // m/s
constexpr double kMovingTurn = 0.05;   // rad/s
// The time in which the robot stops from 0.9 m/s at 1 m/s^2, after a reaction
// time of 0.3 s.
constexpr double kStoppingSeconds = 1.2;
constexpr double kEchoTolerance = 0.1;  // metres beside a disc
constexpr double kScanStep = 0.4;  // metres that somebody may walk in a scan

}  // namespace

double ContactCounter::LastSeen(const Eigen::Vector2d& center) const {
  double nearest = kScanStep, time = -std::numeric_limits<double>::infinity();
  for (const Seen& seen : seen_) {
    const double distance = (seen.center - center).norm();
    if (distance > nearest) continue;
    nearest = distance;
    time = seen.time;
  }
  return time;
}

void ContactCounter::AddScan(const std::vector<Eigen::Vector2d>& echoes,
                             const std::vector<Disc>& moving,
                             const double time) {
  std::vector<Seen> seen;
  for (const Disc& disc : moving) {
    seen.push_back({disc.center, LastSeen(disc.center)});
    for (const Eigen::Vector2d& echo : echoes) {
      if ((echo - disc.center).norm() <= disc.radius + kEchoTolerance) {
        seen.back().time = time;
        break;
      }
    }
  }
  seen_ = std::move(seen);
}

void ContactCounter::Record(const LiveRobot& robot, const bool with_moving,
                            const double unseen_seconds) {
  Contact contact;
  contact.time = robot.time();
  contact.place = robot.pose().translation();
  contact.with_moving = with_moving;
  contact.speed = robot.velocity().linear;
  contact.turn_rate = robot.velocity().angular;
  contact.unseen_seconds = unseen_seconds;
  contacts_.push_back(contact);
}

void ContactCounter::Check(const LiveRobot& robot,
                           const simulation::RayCaster& plan,
                           const std::vector<Disc>& stationary,
                           const std::vector<Disc>& moving) {
  const Eigen::Vector2d place = robot.pose().translation();
  const auto gap = [&](const Disc& disc) {
    return (disc.center - place).norm() - disc.radius - radius_;
  };
  double clearance = plan.Clearance(place, radius_ + 1.) - radius_;
  for (const Disc& disc : stationary)
    clearance = std::min(clearance, gap(disc));
  least_clearance_ = std::min(least_clearance_, clearance);
  if (clearance < 0. && !touches_static_) {
    ++static_collisions_;
    Record(robot, false, 0.);
  }
  touches_static_ = clearance < 0.;

  bool touches = false;
  double last_seen = std::numeric_limits<double>::infinity();
  for (const Disc& disc : moving) {
    if (gap(disc) >= 0.) continue;
    touches = true;
    last_seen = std::min(last_seen, LastSeen(disc.center));
  }
  if (touches && !touches_moving_) {
    ++run_into_;
    collision_counted_ = false;
  }
  touches_moving_ = touches;
  const bool moves = std::abs(robot.velocity().linear) > kMovingSpeed ||
                     std::abs(robot.velocity().angular) > kMovingTurn;
  if (touches && moves && !collision_counted_) {
    collision_counted_ = true;
    ++moving_collisions_;
    --run_into_;
    const double unseen = robot.time() - last_seen;
    unseen_collisions_ += unseen > kStoppingSeconds;
    Record(robot, true, unseen);
  }
}

}  // namespace navigation
}  // namespace cartographer_ext
