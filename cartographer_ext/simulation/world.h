// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A simulated world as read from a world file: the floor plan, the robot with
// its sensors and their faults, its drive and the places to measure. Plain
// data; docs/world_format.md describes the text format, world_parser.h reads
// it.
//
// Frames: world (x east, y north, angles counter-clockwise from east) and robot
// (x forward, y left, origin between the wheels). Units: metres, seconds,
// radians (degrees only in the file).
#ifndef CARTOGRAPHER_EXT_SIMULATION_WORLD_H_
#define CARTOGRAPHER_EXT_SIMULATION_WORLD_H_

#include <string>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/pose2.h"
#include "cartographer_ext/simulation/ray_caster.h"

namespace cartographer_ext {
namespace simulation {

struct LaserSettings {
  int beams = 360;
  double angle_min = -kPi;  // of beam 0, in the laser frame
  double angle_increment = kPi / 180.;
  double min_range = 0.1;  // nearer surfaces give no echo
  double max_range = 25.;
  double noise = 0.01;             // standard deviation, metres
  double proportional_noise = 0.;  // the same per metre of range
  double dropout = 0.;             // probability of no echo
  double outlier = 0.;             // probability of an echo before the wall
  double rate = 10.;               // scans per second
  double resolution = 0.;          // ranges are multiples of it; 0: exact
  double sweep = 0.;               // seconds from first to last beam
  double no_return = 81.91;        // range of a miss
  Pose2 mounting;                  // (robot <- laser)
};

// Differential drive. A wheel's measured travel over a true travel d is
//   (1 + scale) d + noise sqrt(|d|) N(0, 1)   (+ slip),
// counted in whole ticks. The scales of one run are drawn from the seed:
//   right/left = scale_right/left + common +- mismatch / 2,
// with common ~ N(0, scale_sigma^2) and mismatch ~ N(0, mismatch_sigma^2).
//
// Wheels that can roll sideways (mecanum) also slip sideways by
//   lateral_noise sqrt(|d|) N(0, 1)
// which they do not measure.
struct OdometrySettings {
  bool present = true;
  double rate = 20.;            // messages per second
  double encoder_rate = 100.;   // wheel readings per second
  double phase = 0.;            // stamp of the first message, seconds
  double wheel_base = 0.4;      // metres between the wheels
  double ticks_per_meter = 0.;  // 0: not quantised
  double scale_left = 0.;       // systematic, same in every run
  double scale_right = 0.;
  double scale_sigma = 0.;       // common to both wheels, one draw a run
  double mismatch_sigma = 0.;    // right minus left, one draw a run
  double wheel_base_error = 0.;  // assumed / true - 1
  double wheel_base_sigma = 0.;  // one draw a run
  double noise = 0.;             // metres per square root of a metre
  double lateral_noise = 0.;     // the same, sideways
};

// Continuous-time noise densities as in data sheets; white noise of one sample
// has the standard deviation density * sqrt(rate).
struct ImuSettings {
  bool present = false;
  double rate = 100.;
  double gyro_noise = 0.;        // rad/s/sqrt(Hz)
  double gyro_bias_sigma = 0.;   // rad/s, initial bias, one draw a run
  double gyro_bias_walk = 0.;    // rad/s^2/sqrt(Hz)
  double accel_noise = 0.;       // m/s^2/sqrt(Hz)
  double accel_bias_sigma = 0.;  // m/s^2
  double accel_bias_walk = 0.;   // m/s^3/sqrt(Hz)
  double gravity = 9.80665;      // m/s^2, on +z
};

// A disc that moves along its closed path of waypoints repeatedly.
struct MovingObstacle {
  double radius = 0.25;
  double speed = 0.5;
  double phase = 0.;          // fraction of the loop at the start, [0, 1)
  bool random_phase = false;  // drawn from the seed instead
  std::vector<Eigen::Vector2d> path;
};

struct RobotSettings {
  double radius = 0.25;            // for the collision check
  double speed = 0.7;              // m/s
  double acceleration = 0.5;       // m/s^2
  double turn_rate = 0.8;          // rad/s
  double turn_acceleration = 1.5;  // rad/s^2
  double lookahead = 0.6;          // metres; larger cuts corners more
  double jitter = 0.;              // metres each waypoint moves with the seed
  double turn_radius = 0.;         // metres, the least; 0: turns in place
};

struct DriveCommand {
  enum class Kind { kGoto, kReverse, kTurn, kWait };
  Kind kind = Kind::kGoto;
  Eigen::Vector2d target = Eigen::Vector2d::Zero();  // goto, reverse
  double heading = 0.;                               // turn, radians
  double seconds = 0.;                               // wait
  double speed = 0.;                                 // m/s; 0: the robot's own
  std::string where;                                 // "file:line", for errors
};

// A fault of the odometry. Times are relative to the start of the drive.
struct OdometryFault {
  enum class Kind {
    kSlip,     // wheels turn by (1 + gain) of the distance, plus spin
    kStale,    // the messages repeat one pose, then jump to the present
    kJump,     // the odometry frame moves at once by (distance, angle)
    kReverse,  // driving backwards is reported as driving forwards
    kOffset,   // a message stamped t holds the odometry at t + seconds
  };
  Kind kind = Kind::kSlip;
  double start = 0.;      // seconds; of kReverse and kOffset too
  double duration = 0.;   // seconds; kReverse and kOffset: 0: until the end
  bool in_place = false;  // slip: inside a circle, not a time window
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius = 0.;
  double gain_left = 0., gain_right = 0.;  // slip
  double spin_left = 0., spin_right = 0.;  // slip: m/s, also when stationary
  double distance = 0., angle = 0.;        // jump: metres forward, radians
  double seconds = 0.;                     // offset
};

// The driver of the laser stalls: the scan measured at `start`, seconds after the
// start of the drive, is delivered `duration` later with the stamp of that time,
// and those between are lost.
struct ScanStall {
  double start = 0.;
  double duration = 0.;  // seconds
};

// A distance between two opposite walls, to be measured on the finished map.
struct KeyDistance {
  std::string name;
  Eigen::Vector2d a = Eigen::Vector2d::Zero();  // on one wall
  Eigen::Vector2d b = Eigen::Vector2d::Zero();  // on the other
};

// A place the drive passes several times, where closing errors are measured.
struct RevisitPlace {
  std::string name;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double radius = 1.;
};

struct World {
  std::string name;
  std::string description;
  double begin = 100.;  // stamp of the start of the drive, seconds
  std::vector<Segment> segments;
  std::vector<Disc> discs;
  std::vector<MovingObstacle> obstacles;
  LaserSettings laser;
  OdometrySettings odometry;
  ImuSettings imu;
  RobotSettings robot;
  Pose2 start;  // (world <- robot)
  std::vector<DriveCommand> drive;
  std::vector<OdometryFault> faults;
  std::vector<ScanStall> stalls;
  std::vector<KeyDistance> key_distances;
  std::vector<RevisitPlace> places;
};

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_WORLD_H_
