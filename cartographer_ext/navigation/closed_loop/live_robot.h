// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The simulated robot as a plant: commands in, true motion and odometry out.
//
// A command takes effect `command_delay` after it was given. The base follows
// it with bounded acceleration; its wheels turn accordingly, and the ground is
// covered by a little less, wheel by wheel:
//   travel = (1 - slip) * turned,
// where slip is drawn for the run and grows now and then for half a second, as
// on a wet patch. Odometry measures the turns of the wheels, with the errors
// that the world file specifies (simulation/sensors/wheel.h).
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_LIVE_ROBOT_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_LIVE_ROBOT_H_

#include <cstdint>
#include <deque>
#include <utility>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/navigation/robot.h"
#include "cartographer_ext/simulation/sensors/wheel.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace navigation {

struct LiveRobotOptions {
  double command_delay = 0.1;  // seconds
  double slip_sigma = 0.01;    // of each wheel, one draw a run
  double slip_burst = 0.1;     // slip of a burst
  double burst_rate = 0.05;    // bursts a second of driving
  double burst_seconds = 0.5;
};

class LiveRobot {
 public:
  LiveRobot(const simulation::World& world, const RobotLimits& limits,
            const LiveRobotOptions& options, const Pose2& start, uint64_t seed);

  // Given now.
  void Command(const Velocity& command);
  void Advance(double seconds);

  double time() const { return time_; }
  const Pose2& pose() const { return pose_; }             // (world <- robot)
  const Velocity& velocity() const { return velocity_; }  // over ground
  double travelled() const { return travelled_; }         // metres
  const Pose2& odometry() const { return odometry_; }     // (odometry <- robot)

 private:
  const RobotLimits limits_;
  const LiveRobotOptions options_;
  const double wheel_base_;
  double believed_wheel_base_ = 0.;
  Random random_;
  double slip_left_ = 0., slip_right_ = 0.;
  double burst_end_ = 0.;
  bool burst_is_left_ = false;
  simulation::Wheel left_, right_;
  std::deque<std::pair<double, Velocity>> commands_;  // by time of effect
  Velocity target_;
  Velocity turning_;   // what the wheels turn
  Velocity velocity_;  // what the robot does
  double time_ = 0.;
  double travelled_ = 0.;
  Pose2 pose_;
  Pose2 odometry_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_LIVE_ROBOT_H_
