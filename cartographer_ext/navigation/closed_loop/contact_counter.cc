// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/contact_counter.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace navigation {
namespace {

using simulation::Disc;

// Slower is standing still.
constexpr double kMovingSpeed = 0.01;  // m/s
constexpr double kMovingTurn = 0.05;   // rad/s

}  // namespace

void ContactCounter::Record(const LiveRobot& robot, const bool with_moving) {
  Contact contact;
  contact.time = robot.time();
  contact.place = robot.pose().translation();
  contact.with_moving = with_moving;
  contact.speed = robot.velocity().linear;
  contacts_.push_back(contact);
}

void ContactCounter::Check(const LiveRobot& robot,
                           const simulation::RayCaster& plan,
                           const std::vector<Disc>& standing,
                           const std::vector<Disc>& moving) {
  const Eigen::Vector2d place = robot.pose().translation();
  const auto gap = [&](const Disc& disc) {
    return (disc.center - place).norm() - disc.radius - radius_;
  };
  double clearance = plan.Clearance(place, radius_ + 1.) - radius_;
  for (const Disc& disc : standing) clearance = std::min(clearance, gap(disc));
  least_clearance_ = std::min(least_clearance_, clearance);
  if (clearance < 0. && !touches_static_) {
    ++static_collisions_;
    Record(robot, false);
  }
  touches_static_ = clearance < 0.;

  bool touches = false;
  for (const Disc& disc : moving) touches = touches || gap(disc) < 0.;
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
    Record(robot, true);
  }
}

}  // namespace navigation
}  // namespace cartographer_ext
