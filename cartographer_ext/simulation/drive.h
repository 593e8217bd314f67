// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The true motion of the robot as an exact function of time.
//
// The waypoints are driven once, in advance, by a pure-pursuit follower
// (Coulter 1992) with bounded acceleration and turn acceleration: it aims at
// the point of the path one lookahead ahead, slows down before corners and
// stops, and turns in place where the path turns back. The result is a list of
// 10 ms steps, each of constant acceleration and constant turn acceleration, so
// that speed and turn rate are continuous and inside a step
//   s(t)     = s0 + v t + a t^2 / 2            (signed distance)
//   theta(t) = theta0 + w t + alpha t^2 / 2
//   x(t)     = x0 + integral (v + a u) cos theta(u) du   (Gauss-Legendre)
// hold exactly: wheels, gyroscope and laser are computed from one and the same
// motion and agree to rounding.
#ifndef CARTOGRAPHER_EXT_SIMULATION_DRIVE_H_
#define CARTOGRAPHER_EXT_SIMULATION_DRIVE_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace simulation {

struct MotionState {
  Pose2 pose;                // (world <- robot)
  double heading = 0.;       // as pose.theta but not wrapped
  double distance = 0.;      // metres since the start, backwards counts down
  double speed = 0.;         // m/s, negative backwards
  double turn_rate = 0.;     // rad/s
  double acceleration = 0.;  // m/s^2 along the robot's x axis
  double turn_acceleration = 0.;  // rad/s^2
};

class Drive {
 public:
  // Drives the world's waypoints. The seed moves each by up to robot.jitter. An
  // error names the waypoint that cannot be reached.
  static absl::StatusOr<Drive> Plan(const World& world, uint64_t seed);

  // Seconds from start to end.
  double duration() const;
  // `time` in seconds since the start; before and after, the robot is
  // stationary.
  MotionState At(double time) const;
  Pose2 PoseAt(double time) const { return At(time).pose; }
  // Metres driven, forwards and backwards together.
  double length() const { return length_; }

 private:
  Drive() = default;

  std::vector<MotionState> states_;  // at the start of each step
  double length_ = 0.;
};

// Seconds per step of the plan.
constexpr double kDriveStep = 0.01;

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_DRIVE_H_
