// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Motion of the robot from one node to the next by three sources: the finished
// map, local SLAM, and the wheels if there is odometry. Map against local SLAM
// shows distortion by the optimisation; local SLAM against the wheels shows
// errors of one of the two, by slip or by a wrongly matched scan.
#ifndef CARTOGRAPHER_EXT_MAP_VERDICT_MOTION_DISAGREEMENT_H_
#define CARTOGRAPHER_EXT_MAP_VERDICT_MOTION_DISAGREEMENT_H_

#include <map>
#include <vector>

#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/metrics/statistics.h"
#include "cartographer_ext/metrics/trajectory.h"

namespace cartographer_ext {
namespace evaluation {

constexpr double kLastingSeconds = 5.;

// The motion from the previous node to this one. Where nodes in between were
// trimmed, there is no step: over minutes even good odometry turns away.
struct MotionStep {
  GraphId node_id;
  io::TimeNs time = 0;
  double seconds = 0.;
  double metres = 0.;  // by local SLAM
  // Map against local SLAM.
  double bend_translation = 0.;  // metres
  double bend_rotation = 0.;     // radians
  // Local SLAM against the wheels, if there is odometry.
  bool has_odometry = false;
  double odometry_translation = 0.;
  double odometry_rotation = 0.;
  // What of that rotation is left between two nodes kLastingSeconds before and
  // after the step. Odometry that is late, or freezes and then catches up,
  // differs from step to step and not in the end.
  double lasting_rotation = 0.;
};

struct MotionDisagreement {
  std::vector<MotionStep> steps;  // by id; none to first nodes, over gaps
  Statistics bend_translation;    // metres
  Statistics bend_rotation_degrees;
  Statistics odometry_translation;
  Statistics odometry_rotation_degrees;
};

// Odometry of a trajectory, (odometry frame <- robot), by time.
std::map<int, Trajectory> ReadOdometry(const io::Pbstream& pbstream);

MotionDisagreement CompareMotions(const MapGraph& graph,
                                  const std::map<int, Trajectory>& odometry);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_MAP_VERDICT_MOTION_DISAGREEMENT_H_
