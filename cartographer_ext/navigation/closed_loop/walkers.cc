// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/navigation/closed_loop/walkers.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/arc.h"

namespace cartographer_ext {
namespace navigation {
namespace {

constexpr double kTimeStep = 0.1;         // seconds, of the prediction
constexpr double kHeadingSeconds = 0.05;  // along the loop
constexpr double kStationaryPace = 0.02;  // of the walking speed: stationary
constexpr double kNearer = 1e-3;          // metres: less is rounding

}  // namespace

Walkers::Walkers(const simulation::ObstacleMotion* const motion,
                 const simulation::RayCaster* const plan,
                 const double robot_radius, const WalkerOptions& options)
    : motion_(motion),
      plan_(plan),
      robot_radius_(robot_radius),
      options_(options),
      walkers_(motion->size()) {}

std::vector<simulation::Disc> Walkers::At() const {
  std::vector<simulation::Disc> discs;
  for (size_t i = 0; i != walkers_.size(); ++i) {
    discs.push_back(motion_->DiscAt(i, walkers_[i].time));
  }
  return discs;
}

bool Walkers::SeesContact(const size_t index, const Walker& walker,
                          const Pose2& robot, const Velocity& velocity) const {
  const Eigen::Vector2d place = motion_->Position(index, walker.time);
  const Eigen::Vector2d to_robot = robot.translation() - place;
  const double touching = robot_radius_ + motion_->radius(index);
  const double gap = to_robot.norm() - touching;
  if (to_robot.dot(walker.heading) <
          std::cos(options_.half_field_of_view) * to_robot.norm() ||
      !plan_->Visible(place, robot.translation())) {
    return false;
  }
  const int steps = std::lround(options_.anticipation_seconds / kTimeStep);
  for (int i = 1; i <= steps; ++i) {
    const double seconds = i * kTimeStep;
    const Pose2 later =
        robot * ArcPose(velocity.linear * seconds, velocity.angular * seconds);
    const double later_gap =
        (later.translation() -
         motion_->Position(index, walker.time + walker.direction * seconds))
            .norm() -
        touching;
    // Somebody who is too near already may walk away.
    if (later_gap < std::min(options_.clearance, gap - kNearer)) return true;
  }
  return false;
}

void Walkers::Advance(const double seconds, const Pose2& robot,
                      const Velocity& velocity) {
  for (size_t i = 0; i != walkers_.size(); ++i) {
    Walker& walker = walkers_[i];
    const Eigen::Vector2d ahead =
        motion_->Position(i, walker.time + kHeadingSeconds * walker.direction) -
        motion_->Position(i, walker.time);
    if (ahead.norm() > 0.) walker.heading = ahead.normalized();
    const double wish =
        options_.attentive && SeesContact(i, walker, robot, velocity) ? 0. : 1.;
    walker.decided = wish == walker.wanted_pace ? 0. : walker.decided + seconds;
    if (walker.decided >= options_.reaction_seconds) {
      walker.wanted_pace = wish;
      walker.decided = 0.;
    }
    walker.pace += (walker.wanted_pace - walker.pace) *
                   std::min(1., seconds / options_.relaxation_seconds);
    const bool stationary =
        walker.wanted_pace == 0. && walker.pace < kStationaryPace;
    if (stationary) walker.pace = 0.;
    if (walker.wanted_pace == 0.) waited_seconds_ += seconds;
    walker.stopped_seconds = stationary ? walker.stopped_seconds + seconds : 0.;
    if (walker.stopped_seconds >= options_.patience_seconds) {
      walker.direction = -walker.direction;
      walker.stopped_seconds = 0.;
    }
    walker.time += seconds * walker.direction * walker.pace;
  }
}

}  // namespace navigation
}  // namespace cartographer_ext
