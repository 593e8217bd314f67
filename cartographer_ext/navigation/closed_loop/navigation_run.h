// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A whole drive in closed loop and its measurements.
//
//   true pose ─► laser, odometry ─► localisation ─► Navigator ─► LiveRobot ─►
//   true pose
//
// Time advances in steps of 10 ms: the base moves and contacts are counted,
// odometry and scans are taken at their rates, and after each scan the
// navigator gives a command. Contacts are found with the true pose and the true
// shapes.
#ifndef CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_NAVIGATION_RUN_H_
#define CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_NAVIGATION_RUN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "Eigen/Core"
#include "absl/status/statusor.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/sensor_source.h"
#include "cartographer_ext/navigation/closed_loop/contact_counter.h"
#include "cartographer_ext/navigation/closed_loop/disturbances.h"
#include "cartographer_ext/navigation/closed_loop/live_robot.h"
#include "cartographer_ext/navigation/closed_loop/localization_error.h"
#include "cartographer_ext/navigation/closed_loop/walkers.h"
#include "cartographer_ext/navigation/navigator.h"
#include "cartographer_ext/simulation/world.h"

namespace cartographer_ext {
namespace navigation {

struct NavigationRunOptions {
  std::string pbstream_filename;
  uint64_t seed = 1;
  // In the map frame. If empty, this many are drawn from the seed.
  std::vector<Eigen::Vector2d> goals;
  int num_goals = 4;
  int obstacles = 0;
  int crossings = 0;
  int doors = 0;
  // People of the world. Those who cross suddenly never look.
  WalkerOptions people;
  double max_seconds = 1800.;  // of simulated time
  // Of the operator's guess where the robot starts.
  double start_sigma = 0.1;           // metres
  double start_heading_sigma = 0.05;  // radians
  double frame_seconds = 0.2;         // between frames of the recording
  bool record_frames = false;
  // Keeps the readings, to be given to another localisation afterwards.
  bool keep_readings = false;
};

// For picture and animation, in the map frame.
struct NavigationFrame {
  double time = 0.;
  Pose2 true_pose;
  Pose2 pose;  // as localisation reports it
  Velocity velocity;
  DriveState state = DriveState::kDriving;
  size_t goal = 0;
  std::vector<simulation::Disc> stationary;
  std::vector<simulation::Disc> moving;
  std::vector<Eigen::Vector2d> echoes;  // some of them
  std::vector<Eigen::Vector2d> path;
  std::string message;
};

struct NavigationRun {
  Pose2 map_from_world;
  Eigen::Vector2d start;
  std::vector<GoalResult> goals;
  // Of each goal the distance of the true position when it was reported.
  std::vector<double> goal_errors;
  double seconds = 0.;    // simulated
  double travelled = 0.;  // metres
  double shortest = 0.;   // of the goals that were reached
  double path_ratio = 0.;
  int static_collisions = 0;
  int moving_collisions = 0;  // with the robot moving
  int unseen_collisions = 0;  // of these, with somebody not seen lately
  int run_into = 0;           // with the robot stationary
  // Seconds for which people waited for the robot, summed over people.
  double people_waited_seconds = 0.;
  double least_clearance = 0.;  // metres, to stationary things
  std::vector<Disturbance> disturbances;
  std::vector<LocalizationError> localization;
  int jumps = 0;  // above half a metre
  int lost_cycles = 0;
  int plans = 0;
  int recoveries = 0;
  int times_given_way = 0;
  int late_optimizations = 0;
  std::vector<double> cycle_seconds;  // CPU of the navigator, each cycle
  double planning_cpu_seconds = 0.;
  double localization_cpu_seconds = 0.;
  std::vector<Pose2> true_path;  // map frame, every scan
  std::vector<io::SensorEvent> readings;
  std::vector<Pose2> true_poses;  // (map <- robot) of each scan in readings
  Pose2 initial_pose;             // (map <- robot), as given to localisation
  std::vector<NavigationFrame> frames;
  io::OccupancyMap map;
  double robot_radius = 0.;   // metres
  double frame_seconds = 0.;  // between frames
  std::vector<Contact> contacts;

  int reached() const;
};

// Errors: a map without free space, a start outside of it, no room for goals or
// disturbances, and those of the localisation.
absl::StatusOr<NavigationRun> RunNavigation(
    const simulation::World& world, const io::OccupancyMap& map,
    const evaluation::SlamConfiguration& configuration,
    const NavigationRunOptions& options);

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_NAVIGATION_CLOSED_LOOP_NAVIGATION_RUN_H_
