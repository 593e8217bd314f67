// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/presets.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "cartographer_ext/simulation/drive.h"
#include "cartographer_ext/simulation/random_faults.h"

namespace cartographer_ext {
namespace simulation {
namespace {

struct LaserSheet {
  const char* name;
  int beams;
  double field_of_view;  // degrees
  double min_range;
  double max_range;
  double rate;
  double noise;
  double proportional_noise;
  double dropout;
  double resolution;
};

// The sweep follows from the field of view and the rate of a mirror that turns
// once a scan; the depth camera's sensor sees all columns at once.
constexpr LaserSheet kLasers[] = {
    {"depth_camera", 320, 57., 0.45, 4.5, 15., 0.004, 0.006, 0.02, 0.005},
    {"rplidar_a1", 360, 360., 0.15, 12., 5.5, 0.004, 0.008, 0.03, 0.001},
    {"ld06", 450, 360., 0.02, 12., 10., 0.01, 0.002, 0.02, 0.001},
    {"urg_04lx", 683, 240., 0.06, 5.6, 10., 0.006, 0.005, 0.01, 0.001},
    {"utm_30lx", 1081, 270., 0.1, 30., 40., 0.01, 0.0007, 0.005, 0.001},
    {"sick_lms", 361, 180., 0.1, 80., 10., 0.008, 0.0002, 0.005, 0.01}};

// The mirror of an LMS 2xx turns at 75 Hz, whatever rate its serial line can
// transmit.
constexpr double kSickMirrorRate = 75.;

absl::Status Unknown(const std::string& what, const std::string& name,
                     const std::vector<std::string>& names) {
  return absl::InvalidArgumentError(absl::StrCat("there is no ", what, " '",
                                                 name, "', expected one of ",
                                                 absl::StrJoin(names, ", ")));
}

}  // namespace

const std::vector<std::string>& LaserPresetNames() {
  static const auto* const names = [] {
    auto* const list = new std::vector<std::string>;
    for (const LaserSheet& sheet : kLasers) list->push_back(sheet.name);
    return list;
  }();
  return *names;
}

const std::vector<std::string>& RobotPresetNames() {
  static const auto* const names =
      new std::vector<std::string>{"differential", "mecanum", "car"};
  return *names;
}

const std::vector<std::string>& OdometryPresetNames() {
  static const auto* const names =
      new std::vector<std::string>{"good", "fair", "poor", "none"};
  return *names;
}

absl::StatusOr<LaserSettings> LaserPreset(const std::string& name) {
  for (const LaserSheet& sheet : kLasers) {
    if (name != sheet.name) continue;
    LaserSettings laser;
    const bool full_turn = sheet.field_of_view == 360.;
    laser.beams = sheet.beams;
    laser.angle_min = DegToRad(-0.5 * sheet.field_of_view);
    laser.angle_increment = DegToRad(sheet.field_of_view) /
                            (full_turn ? sheet.beams : sheet.beams - 1);
    laser.min_range = sheet.min_range;
    laser.max_range = sheet.max_range;
    laser.noise = sheet.noise;
    laser.proportional_noise = sheet.proportional_noise;
    laser.dropout = sheet.dropout;
    laser.outlier = 0.001;
    laser.rate = sheet.rate;
    laser.resolution = sheet.resolution;
    const double mirror_rate =
        name == "sick_lms" ? kSickMirrorRate : sheet.rate;
    laser.sweep = name == "depth_camera"
                      ? 0.
                      : (sheet.beams - 1) * laser.angle_increment /
                            (2. * kPi * mirror_rate);
    return laser;
  }
  return Unknown("laser", name, LaserPresetNames());
}

absl::StatusOr<RobotPresetSettings> RobotPreset(const std::string& name) {
  RobotPresetSettings preset;
  RobotSettings& robot = preset.robot;
  OdometrySettings& odometry = preset.odometry;
  robot.radius = 0.22;
  robot.speed = 0.7;
  robot.lookahead = 0.45;
  odometry.phase = 0.02;
  odometry.ticks_per_meter = 4000.;
  if (name == "differential") return preset;
  if (name == "mecanum") {
    robot.radius = 0.28;
    robot.acceleration = 0.8;
    robot.turn_rate = 1.2;
    robot.turn_acceleration = 3.;
    odometry.rate = 50.;
    odometry.ticks_per_meter = 2000.;
    odometry.lateral_noise = 0.006;
    return preset;
  }
  if (name == "car") {
    robot.radius = 0.45;
    robot.speed = 1.5;
    robot.acceleration = 0.7;
    robot.turn_rate = 1.;
    robot.turn_acceleration = 2.;
    robot.lookahead = 1.5;
    robot.turn_radius = 0.9;
    odometry.rate = 50.;
    odometry.wheel_base = 0.7;
    odometry.ticks_per_meter = 500.;
    return preset;
  }
  return Unknown("robot", name, RobotPresetNames());
}

absl::Status ApplyOdometryPreset(const std::string& name, const uint64_t seed,
                                 World* world) {
  const auto& names = OdometryPresetNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return Unknown("grade of odometry", name, names);
  OdometrySettings& odometry = world->odometry;
  odometry.present = name != "none";
  if (!odometry.present) return absl::OkStatus();
  odometry.scale_left = odometry.scale_right = odometry.wheel_base_error = 0.;
  // Factor of the noise, relative to the shipped worlds.
  const double grade = name == "good" ? 0.2 : name == "fair" ? 1. : 2.5;
  odometry.scale_sigma = odometry.wheel_base_sigma = 0.02 * grade;
  odometry.mismatch_sigma = 0.005 * grade;
  odometry.noise = 0.004 * grade;
  odometry.lateral_noise *= grade;
  if (name != "poor") return absl::OkStatus();
  constexpr double kSecondsPerSlip = 60.;
  const absl::StatusOr<Drive> drive = Drive::Plan(*world, seed);
  if (!drive.ok()) return drive.status();
  const int slips = static_cast<int>(drive->duration() / kSecondsPerSlip);
  const absl::StatusOr<std::vector<OdometryFault>> faults =
      RandomFaults(absl::StrCat("slip:", slips), *drive, seed);
  if (!faults.ok()) return faults.status();
  world->faults.insert(world->faults.end(), faults->begin(), faults->end());
  return absl::OkStatus();
}

}  // namespace simulation
}  // namespace cartographer_ext
