// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The people of a world while a robot drives among them. Each walks its closed
// loop of waypoints. An attentive walker who sees the robot does not walk into
// it: whoever would come too near to it within the next seconds, both going on
// as they do, stops until the path is free, and turns round after some time. A
// robot behind or out of sight is not noticed. An inattentive walker keeps to
// its loop and walks through whatever is there.
//
// The figures are those of models of pedestrians, on the careless side:
//  - Field of view of 200 degrees and a relaxation time of 0.5 s: Helbing and
//    Molnar, "Social force model for pedestrian dynamics", Physical Review E
//    51(5), 1995. Here 0.5 s of reaction come before.
//  - People evade contacts expected within 3 s: Karamouzas, Skinner and Guy,
//    "Universal power law governing pedestrian interactions", Physical Review
//    Letters 113(23), 2014. Here within 2 s only.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_WALKERS_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_WALKERS_H_

#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/navigation/robot.h"
#include "cartographer_ext/simulation/obstacle_motion.h"
#include "cartographer_ext/simulation/ray_caster.h"

namespace cartographer_ext {
namespace navigation {

struct WalkerOptions {
  bool attentive = true;
  double half_field_of_view = 1.745;  // radians from the walking direction
  double anticipation_seconds = 2.;
  double reaction_seconds = 0.5;    // until a stop or a start begins
  double relaxation_seconds = 0.5;  // of the speed towards the wanted one
  double clearance = 0.15;          // metres kept from the robot's outline
  double patience_seconds = 3.;     // stopped, before turning round
};

class Walkers {
 public:
  // `motion` and `plan` (world frame; walls hide the robot) must outlive this.
  Walkers(const simulation::ObstacleMotion* motion,
          const simulation::RayCaster* plan, double robot_radius,
          const WalkerOptions& options);

  // Lets everybody walk for `seconds`, with the robot at this pose (world
  // frame) and of this velocity.
  void Advance(double seconds, const Pose2& robot, const Velocity& velocity);

  // Where they are now, world frame.
  std::vector<simulation::Disc> At() const;
  // Seconds for which somebody stopped for the robot, summed over everybody.
  double waited_seconds() const { return waited_seconds_; }

 private:
  struct Walker {
    double time = 0.;         // on its loop
    double direction = 1.;    // along the loop; -1 after turning round
    double pace = 1.;         // present share of its walking speed
    double wanted_pace = 1.;  // 0 or 1
    double decided = 0.;      // seconds for which it has wanted the other one
    double stopped_seconds = 0.;
    Eigen::Vector2d heading = Eigen::Vector2d::Zero();
  };

  // Whether somebody sees that going on leads too near to the robot.
  bool SeesContact(size_t index, const Walker& walker, const Pose2& robot,
                   const Velocity& velocity) const;

  const simulation::ObstacleMotion* const motion_;
  const simulation::RayCaster* const plan_;
  const double robot_radius_;
  const WalkerOptions options_;
  std::vector<Walker> walkers_;
  double waited_seconds_ = 0.;
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_WALKERS_H_
