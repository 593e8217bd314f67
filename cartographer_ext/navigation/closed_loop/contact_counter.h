// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Counts contacts of the robot by the true shapes. A moving obstacle may run
// into a stationary robot; a contact during which the robot itself moves at any
// time is a collision.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_CONTACT_COUNTER_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_CONTACT_COUNTER_H_

#include <limits>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/navigation/closed_loop/live_robot.h"
#include "cartographer_ext/simulation/ray_caster.h"

namespace cartographer_ext {
namespace navigation {

struct Contact {
  double time = 0.;       // when it began, or when the robot moved in it
  Eigen::Vector2d place;  // of the robot
  bool with_moving = false;
  double speed = 0.;      // of the robot, m/s
  double turn_rate = 0.;  // of the robot, rad/s
  // Of what moves: seconds since an echo came from it; infinite for never.
  double unseen_seconds = 0.;
};

class ContactCounter {
 public:
  explicit ContactCounter(double robot_radius) : radius_(robot_radius) {}

  // The echoes of a scan and the moving obstacles at its time.
  void AddScan(const std::vector<Eigen::Vector2d>& echoes,
               const std::vector<simulation::Disc>& moving, double time);
  // To be called a few times per decimetre of driving; world frame.
  void Check(const LiveRobot& robot, const simulation::RayCaster& plan,
             const std::vector<simulation::Disc>& stationary,
             const std::vector<simulation::Disc>& moving);

  int static_collisions() const { return static_collisions_; }
  int moving_collisions() const { return moving_collisions_; }
  // Of these, collisions with somebody whom the laser had not seen for longer
  // than the robot needs to stop: from outside its field of view.
  int unseen_collisions() const { return unseen_collisions_; }
  int run_into() const { return run_into_; }
  // Metres from the outline to stationary things, the least so far.
  double least_clearance() const { return least_clearance_; }
  const std::vector<Contact>& contacts() const { return contacts_; }

 private:
  struct Seen {
    Eigen::Vector2d center;
    double time;
  };

  void Record(const LiveRobot& robot, bool with_moving, double unseen_seconds);
  // When what is here now was last seen.
  double LastSeen(const Eigen::Vector2d& center) const;

  const double radius_;
  bool touches_static_ = false;
  bool touches_moving_ = false;
  bool collision_counted_ = false;  // of the present contact
  int static_collisions_ = 0;
  int moving_collisions_ = 0;
  int unseen_collisions_ = 0;
  std::vector<Seen> seen_;  // all that moves, at the last scan
  int run_into_ = 0;
  double least_clearance_ = std::numeric_limits<double>::infinity();
  std::vector<Contact> contacts_;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_CONTACT_COUNTER_H_
