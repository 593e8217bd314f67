// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/world_writer.h"

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace simulation {
namespace {

std::string Number(const double value) {
  return absl::StrFormat("%.9g", value == 0. ? 0. : value);
}

std::string Point(const Eigen::Vector2d& point) {
  return absl::StrCat(Number(point.x()), " ", Number(point.y()));
}

std::string Option(const char* key, const double value) {
  return absl::StrCat(" ", key, "=", Number(value));
}

// Writes only values that differ from the default.
std::string Option(const char* key, const double value, const double fallback) {
  return value == fallback ? "" : Option(key, value);
}

std::string SurfaceOptions(const Segment& segment) {
  return Option("reflectivity", segment.reflectivity, 1.) +
         (segment.echo_angle < kAnyAngle
              ? Option("echo_angle", RadToDeg(segment.echo_angle))
              : "");
}

void AddPlan(const World& world, std::string* text) {
  // Joins segments that continue where the previous one ends into a polyline.
  for (size_t i = 0; i != world.segments.size();) {
    const Segment& first = world.segments[i];
    const std::string options = SurfaceOptions(first);
    absl::StrAppend(text, "polyline  ", Point(first.a));
    size_t j = i;
    do {
      absl::StrAppend(text, " ", Point(world.segments[j].b));
      ++j;
    } while (j != world.segments.size() && j < i + 16 &&
             world.segments[j].a == world.segments[j - 1].b &&
             SurfaceOptions(world.segments[j]) == options);
    absl::StrAppend(text, options, "\n");
    i = j;
  }
  for (const Disc& disc : world.discs) {
    absl::StrAppend(text, "circle    ", Point(disc.center), " ",
                    Number(disc.radius),
                    Option("reflectivity", disc.reflectivity, 1.), "\n");
  }
}

void AddLaser(const LaserSettings& laser, std::string* text) {
  absl::StrAppend(
      text, "laser    ", Option("beams", laser.beams),
      Option("first", RadToDeg(laser.angle_min)),
      Option("increment", RadToDeg(laser.angle_increment)),
      Option("min_range", laser.min_range),
      Option("max_range", laser.max_range), Option("noise", laser.noise),
      Option("proportional_noise", laser.proportional_noise, 0.),
      Option("dropout", laser.dropout, 0.),
      Option("outlier", laser.outlier, 0.), Option("rate", laser.rate),
      Option("resolution", laser.resolution, 0.),
      Option("sweep", laser.sweep, 0.), Option("no_return", laser.no_return),
      Option("x", laser.mounting.x, 0.), Option("y", laser.mounting.y, 0.),
      Option("theta", RadToDeg(laser.mounting.theta), 0.), "\n");
}

void AddOdometry(const OdometrySettings& odometry, std::string* text) {
  absl::StrAppend(text, "odometry ", odometry.present ? "" : " none",
                  Option("rate", odometry.rate),
                  Option("encoder_rate", odometry.encoder_rate),
                  Option("phase", odometry.phase, 0.),
                  Option("wheel_base", odometry.wheel_base),
                  Option("ticks_per_metre", odometry.ticks_per_meter, 0.),
                  Option("scale_left", odometry.scale_left, 0.),
                  Option("scale_right", odometry.scale_right, 0.),
                  Option("scale_sigma", odometry.scale_sigma, 0.),
                  Option("mismatch_sigma", odometry.mismatch_sigma, 0.),
                  Option("wheel_base_error", odometry.wheel_base_error, 0.),
                  Option("wheel_base_sigma", odometry.wheel_base_sigma, 0.),
                  Option("noise", odometry.noise, 0.),
                  Option("lateral_noise", odometry.lateral_noise, 0.), "\n");
}

void AddImu(const ImuSettings& imu, std::string* text) {
  if (!imu.present) return;
  absl::StrAppend(text, "imu      ", Option("rate", imu.rate),
                  Option("gyro_noise", imu.gyro_noise, 0.),
                  Option("gyro_bias_sigma", imu.gyro_bias_sigma, 0.),
                  Option("gyro_bias_walk", imu.gyro_bias_walk, 0.),
                  Option("accel_noise", imu.accel_noise, 0.),
                  Option("accel_bias_sigma", imu.accel_bias_sigma, 0.),
                  Option("accel_bias_walk", imu.accel_bias_walk, 0.),
                  Option("gravity", imu.gravity), "\n");
}

void AddRobot(const RobotSettings& robot, std::string* text) {
  absl::StrAppend(
      text, "robot    ", Option("radius", robot.radius),
      Option("speed", robot.speed), Option("acceleration", robot.acceleration),
      Option("turn_rate", robot.turn_rate),
      Option("turn_acceleration", robot.turn_acceleration),
      Option("lookahead", robot.lookahead), Option("jitter", robot.jitter, 0.),
      Option("turn_radius", robot.turn_radius, 0.), "\n");
}

void AddObstacle(const MovingObstacle& obstacle, std::string* text) {
  absl::StrAppend(
      text, "obstacle ", Option("radius", obstacle.radius),
      Option("speed", obstacle.speed),
      obstacle.random_phase ? " phase=random" : Option("phase", obstacle.phase),
      " path");
  for (const Eigen::Vector2d& point : obstacle.path) {
    absl::StrAppend(text, " ", Point(point));
  }
  absl::StrAppend(text, "\n");
}

void AddCommand(const DriveCommand& command, std::string* text) {
  switch (command.kind) {
    case DriveCommand::Kind::kGoto:
    case DriveCommand::Kind::kReverse:
      absl::StrAppend(text,
                      command.kind == DriveCommand::Kind::kGoto ? "goto      "
                                                                : "reverse   ",
                      Point(command.target), Option("speed", command.speed, 0.),
                      "\n");
      return;
    case DriveCommand::Kind::kTurn:
      absl::StrAppend(text, "turn      ", Number(RadToDeg(command.heading)),
                      "\n");
      return;
    case DriveCommand::Kind::kWait:
      absl::StrAppend(text, "wait      ", Number(command.seconds), "\n");
      return;
  }
}

void AddFault(const OdometryFault& fault, std::string* text) {
  using Kind = OdometryFault::Kind;
  absl::StrAppend(text, "fault     ");
  switch (fault.kind) {
    case Kind::kSlip:
      absl::StrAppend(text, "slip", Option("start", fault.start),
                      Option("duration", fault.duration),
                      Option("left", fault.gain_left, 0.),
                      Option("right", fault.gain_right, 0.),
                      Option("spin_left", fault.spin_left, 0.),
                      Option("spin_right", fault.spin_right, 0.));
      if (fault.in_place) {
        absl::StrAppend(text, Option("x", fault.center.x()),
                        Option("y", fault.center.y()),
                        Option("radius", fault.radius));
      }
      break;
    case Kind::kStale:
      absl::StrAppend(text, "stale", Option("start", fault.start),
                      Option("duration", fault.duration));
      break;
    case Kind::kJump:
      absl::StrAppend(text, "jump", Option("start", fault.start),
                      Option("distance", fault.distance),
                      Option("angle", RadToDeg(fault.angle)));
      break;
    case Kind::kReverse:
      absl::StrAppend(text, "reverse", Option("start", fault.start),
                      Option("duration", fault.duration));
      break;
    case Kind::kOffset:
      absl::StrAppend(text, "offset", Option("start", fault.start),
                      Option("duration", fault.duration),
                      Option("seconds", fault.seconds));
      break;
  }
  absl::StrAppend(text, "\n");
}

}  // namespace

std::string FormatWorld(const World& world) {
  std::string text = absl::StrCat("world     ", world.name, "\n");
  if (!world.description.empty()) {
    absl::StrAppend(&text, "describe  ", world.description, "\n");
  }
  absl::StrAppend(&text, "begin     ", Number(world.begin), "\n\n");
  AddPlan(world, &text);
  text += "\n";
  AddLaser(world.laser, &text);
  AddOdometry(world.odometry, &text);
  AddImu(world.imu, &text);
  AddRobot(world.robot, &text);
  for (const MovingObstacle& obstacle : world.obstacles) {
    AddObstacle(obstacle, &text);
  }
  absl::StrAppend(&text, "\nstart     ", Point(world.start.translation()), " ",
                  Number(RadToDeg(world.start.theta)), "\n");
  for (const DriveCommand& command : world.drive) AddCommand(command, &text);
  text += "\n";
  for (const OdometryFault& fault : world.faults) AddFault(fault, &text);
  for (const ScanStall& stall : world.stalls) {
    absl::StrAppend(&text, "fault     stall", Option("start", stall.start),
                    Option("duration", stall.duration), "\n");
  }
  for (const KeyDistance& distance : world.key_distances) {
    absl::StrAppend(&text, "key_distance ", distance.name, " ",
                    Point(distance.a), " ", Point(distance.b), "\n");
  }
  for (const RevisitPlace& place : world.places) {
    absl::StrAppend(&text, "revisit   ", place.name, " ", Point(place.position),
                    Option("radius", place.radius), "\n");
  }
  return text;
}

}  // namespace simulation
}  // namespace cartographer_ext
