// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What a simulated run can be measured against: the true trajectory at every
// scan, relations between pairs of scans, true loop closures, visits of marked
// places, and wall-to-wall distances with the scans that saw their ends.
//
// All times are stamps of scans. Poses are (world <- robot).
#ifndef CARTOGRAPHER_EXT_SIMULATION_TRUTH_H_
#define CARTOGRAPHER_EXT_SIMULATION_TRUTH_H_

#include <string>
#include <vector>

#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/simulation/simulation.h"

namespace cartographer_ext {
namespace simulation {

struct TruePose {
  io::TimeNs time = 0;
  Pose2 pose;  // (world <- robot)
};

std::vector<TruePose> TrueTrajectory(const Simulation& simulation);

// Pose at `second` seen from `first`: (robot at first <- robot at second).
struct TrueRelation {
  io::TimeNs first = 0;
  io::TimeNs second = 0;
  Pose2 relative;
};

// Consecutive samples of the trajectory, about 1 m or 30 degrees apart.
std::vector<TrueRelation> SequentialRelations(
    const std::vector<TruePose>& trajectory);

// Samples (about 1 m apart) that lie within 1.5 m of an earlier pass more
// than 60 s before, with the straight line between them free of walls. One
// relation per earlier pass: the nearest sample of it. A laser that sees less
// than 270 degrees must also have the same heading within 60 degrees.
std::vector<TrueRelation> LoopRelations(
    const Simulation& simulation, const std::vector<TruePose>& trajectory);

struct PlaceVisit {
  std::string place;
  int visit = 0;  // from 1
  io::TimeNs time = 0;
  Pose2 pose;            // (world <- robot)
  double distance = 0.;  // metres from the mark
};

// For every marked place, the nearest scan of each pass within its radius;
// passes are at least 10 s apart.
std::vector<PlaceVisit> PlaceVisits(const Simulation& simulation,
                                    const std::vector<TruePose>& trajectory);

// Transporting the wall point a by the pose estimated at time_a, and b by the
// one at time_b, gives the distance on the estimated map:
//   |T_b (pose_b^-1 b) - T_a (pose_a^-1 a)|  with T the estimates.
struct KeyDistanceView {
  KeyDistance distance;
  double length = 0.;     // metres, true
  bool seen = false;      // both ends were seen by some scan
  io::TimeNs time_a = 0;  // the scan nearest to a that sees it
  io::TimeNs time_b = 0;
  Eigen::Vector2d a_in_robot = Eigen::Vector2d::Zero();  // at time_a
  Eigen::Vector2d b_in_robot = Eigen::Vector2d::Zero();  // at time_b
};

std::vector<KeyDistanceView> KeyDistanceViews(
    const Simulation& simulation, const std::vector<TruePose>& trajectory);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_TRUTH_H_
