// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/live_robot.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/arc.h"
#include "cartographer_ext/simulation/seeds.h"

namespace cartographer_ext {
namespace navigation {
namespace {

// Streams of random numbers in addition to those of the simulator.
constexpr uint64_t kStream = 101;

double Toward(const double from, const double to, const double step) {
  return from + std::max(-step, std::min(step, to - from));
}

}  // namespace

LiveRobot::LiveRobot(const simulation::World& world, const RobotLimits& limits,
                     const LiveRobotOptions& options, const Pose2& start,
                     const uint64_t seed)
    : limits_(limits),
      options_(options),
      wheel_base_(world.odometry.wheel_base),
      random_(simulation::MixBits(simulation::MixBits(seed) ^ kStream)),
      left_(0., 0., 0.),
      right_(0., 0., 0.),
      pose_(start) {
  const simulation::OdometrySettings& odometry = world.odometry;
  const double common = odometry.scale_sigma * random_.Normal();
  const double mismatch = odometry.mismatch_sigma * random_.Normal();
  left_ = simulation::Wheel(odometry.scale_left + common - 0.5 * mismatch,
                            odometry.noise, odometry.ticks_per_meter);
  right_ = simulation::Wheel(odometry.scale_right + common + 0.5 * mismatch,
                             odometry.noise, odometry.ticks_per_meter);
  believed_wheel_base_ =
      wheel_base_ * (1. + odometry.wheel_base_error +
                     odometry.wheel_base_sigma * random_.Normal());
  slip_left_ = std::abs(options.slip_sigma * random_.Normal());
  slip_right_ = std::abs(options.slip_sigma * random_.Normal());
}

void LiveRobot::Command(const Velocity& command) {
  commands_.emplace_back(time_ + options_.command_delay, command);
}

void LiveRobot::Advance(const double seconds) {
  time_ += seconds;
  while (!commands_.empty() && commands_.front().first <= time_ + 1e-9) {
    target_ = commands_.front().second;
    commands_.pop_front();
  }
  // Speeding up and slowing down, also through zero.
  const bool braking = std::abs(target_.linear) < std::abs(turning_.linear) ||
                       target_.linear * turning_.linear < 0.;
  turning_.linear =
      Toward(turning_.linear, target_.linear,
             seconds * (braking ? limits_.deceleration : limits_.acceleration));
  turning_.angular = Toward(turning_.angular, target_.angular,
                            seconds * limits_.turn_acceleration);
  const double half_base = 0.5 * wheel_base_;
  const double left =
      seconds * (turning_.linear - half_base * turning_.angular);
  const double right =
      seconds * (turning_.linear + half_base * turning_.angular);
  const bool moving = left != 0. || right != 0.;
  if (moving && time_ >= burst_end_ &&
      random_.Uniform() < options_.burst_rate * seconds) {
    burst_end_ = time_ + options_.burst_seconds;
    burst_is_left_ = random_.Uniform() < 0.5;
  }
  const double burst = time_ < burst_end_ ? options_.slip_burst : 0.;
  const double ground_left =
      left * (1. - slip_left_ - (burst_is_left_ ? burst : 0.));
  const double ground_right =
      right * (1. - slip_right_ - (burst_is_left_ ? 0. : burst));
  const double length = 0.5 * (ground_left + ground_right);
  const double angle = (ground_right - ground_left) / wheel_base_;
  pose_ = pose_ * ArcPose(length, angle);
  velocity_ = {length / seconds, angle / seconds};
  travelled_ += std::abs(length);
  const double counted_left = left_.Advance(left, 0., &random_);
  const double counted_right = right_.Advance(right, 0., &random_);
  odometry_ = odometry_ *
              ArcPose(0.5 * (counted_left + counted_right),
                      (counted_right - counted_left) / believed_wheel_base_);
}

}  // namespace navigation
}  // namespace cartographer_ext
