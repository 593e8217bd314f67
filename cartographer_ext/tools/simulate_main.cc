// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: simulation io
//
// cartographer_ext_simulate: drives a robot through a world file and writes the
// readings of its sensors and the ground truth.
#include <cstdint>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/common/progress.h"
#include "cartographer_ext/simulation/buildings/building.h"
#include "cartographer_ext/simulation/random_faults.h"
#include "cartographer_ext/simulation/sensors/presets.h"
#include "cartographer_ext/simulation/simulation_output.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/simulation/world_picture.h"
#include "cartographer_ext/simulation/world_writer.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(
    world_filename, "",
    "World file: floor plan, robot, sensors, drive. The format is described in "
    "docs/world_format.md; examples are in configuration_files/worlds.");
DEFINE_string(
    generate, "",
    "Generate a world instead of reading one: office, hotel, warehouse, hall, "
    "street or campus. The plan depends on the seed.");
DEFINE_int32(laps, 1, "-generate: number of laps, 1 to 20.");
DEFINE_string(laser, "",
              "Laser: depth_camera, rplidar_a1, ld06, urg_04lx, utm_30lx or "
              "sick_lms. Empty: the world's own; -generate: ld06.");
DEFINE_string(robot, "",
              "Robot: differential, mecanum or car. Empty: the world's own; "
              "-generate: differential. A car cannot turn in place and needs a "
              "warehouse, hall, street or campus.");
DEFINE_string(odometry, "",
              "Errors of the wheels: good, fair, poor (with slips) or none (no "
              "odometry). Empty: the world's own; -generate: fair.");
DEFINE_string(world_output_filename, "",
              "Output: the world, including the presets, as a world file.");
DEFINE_uint64(seed, 0,
              "Seed of noise, biases, obstacle phases and random faults. The "
              "same world and seed always give the same files.");
DEFINE_string(
    output_filestem, "",
    "Output: <stem>.clf (log), .tum (ground truth at every scan), "
    ".relations (true relative poses), .truth.loops.csv, .places.csv, "
    ".distances.csv, .faults.csv and .truth.pgm/.yaml.");
DEFINE_bool(carmen, true, "Write the CARMEN log <stem>.clf.");
DEFINE_bool(bag, false,
            "Also write the ROS 1 bag <stem>.bag, which has the IMU.");
DEFINE_bool(
    mcap, false,
    "Also write the ROS 2 recording <stem>.mcap (zstd), which has the IMU.");
DEFINE_bool(db3, false,
            "Also write the ROS 2 recording <stem>.db3, which has the IMU.");
DEFINE_bool(truth_map, true, "Write the ideal map.");
DEFINE_double(resolution, 0.05, "Resolution of that map, metres per cell.");
DEFINE_string(
    picture_filename, "",
    "Output: PNG of the plan, the path, the obstacles and the marks.");
DEFINE_int32(picture_pixels, 1600, "Longer side of the picture, pixels.");
DEFINE_string(odometry_faults, "",
              "Faults at random times in addition to those of the world, comma "
              "separated: stale:N, jump:N, slip:N, reverse, offset:SECONDS.");
DEFINE_int32(
    scan_stalls, 0,
    "Times, in addition to those of the world, at which the laser's "
    "driver holds a scan back for 0.4 to 1 s: its stamp is that of the "
    "delivery, and the scans between are lost.");
DEFINE_bool(perfect, false,
            "Simulate sensors without noise, bias, dropouts or faults.");
DEFINE_string(json, "", "Output: summary as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr char kDescription[] =
    R"(Simulates a robot with a laser, wheel odometry and an IMU, with ground truth.

Look at a world before using it:
  cartographer_ext_simulate \
      -world_filename=configuration_files/worlds/ri_corridor.world \
      -picture_filename=/tmp/ri.png
Make a log with ground truth, then map and evaluate it:
  cartographer_ext_simulate \
      -world_filename=configuration_files/worlds/ri_corridor.world \
      -seed=3 -output_filestem=/tmp/ri
  cartographer_ext_slam -input_filename=/tmp/ri.clf \
      -pbstream_filename=/tmp/ri.pbstream
  cartographer_ext_evaluate -pbstream_filename=/tmp/ri.pbstream \
      -relations_filename=/tmp/ri.relations \
      -reference_trajectory_filename=/tmp/ri.tum
Add odometry faults:
  ... -odometry_faults=stale:3,jump:2,slip:2,offset:0.12

A building generated from a seed, with sensors of your choice:
  cartographer_ext_simulate -generate=hotel -seed=17 -laser=rplidar_a1 \
      -odometry=poor -laps=2 -output_filestem=/tmp/hotel -mcap \
      -world_output_filename=/tmp/hotel.world -picture_filename=/tmp/hotel.png
The same sensors in a world of your own:
  cartographer_ext_simulate -world_filename=my.world -laser=depth_camera \
      -output_filestem=/tmp/mine

Format of worlds and output files, and values of the presets:
docs/world_format.md.)";

nlohmann::ordered_json Report(const simulation::Simulation& simulation,
                              const simulation::SimulationSummary& summary,
                              const double cpu_seconds) {
  nlohmann::ordered_json json;
  json["world"] = simulation.world().name;
  json["seed"] = simulation.options().seed;
  json["laser_beams_per_second"] =
      simulation.world().laser.beams * simulation.world().laser.rate;
  json["people"] = simulation.obstacles().size();
  json["sensor_seconds"] = simulation.drive().duration();
  json["driven_metres"] = simulation.drive().length();
  json["scans"] = summary.scans;
  json["odometry_readings"] = summary.odometry_readings;
  json["imu_readings"] = summary.imu_readings;
  json["relations"]["sequential"] = summary.sequential_relations;
  json["relations"]["loop"] = summary.loop_relations;
  json["place_visits"] = summary.place_visits;
  json["odometry_faults"] = simulation.odometry().labels.size();
  json["odometry"]["scale_left"] = simulation.odometry().scale_left;
  json["odometry"]["scale_right"] = simulation.odometry().scale_right;
  json["odometry"]["believed_wheel_base"] =
      simulation.odometry().believed_wheel_base;
  json["cpu_seconds"] = cpu_seconds;
  json["files"] = summary.files;
  return json;
}

// The MEMS unit of the shipped worlds.
simulation::ImuSettings SmallImu() {
  simulation::ImuSettings imu;
  imu.present = true;
  imu.gyro_noise = 1e-4;
  imu.gyro_bias_sigma = 1e-3;
  imu.gyro_bias_walk = 1e-5;
  imu.accel_noise = 4e-3;
  imu.accel_bias_sigma = 0.03;
  imu.accel_bias_walk = 3e-4;
  return imu;
}

absl::StatusOr<simulation::World> GenerateWorld() {
  const auto kind = simulation::BuildingKindByName(FLAGS_generate);
  if (!kind.ok()) return kind.status();
  const auto robot = simulation::RobotPreset(
      FLAGS_robot.empty() ? "differential" : FLAGS_robot);
  if (!robot.ok()) return robot.status();
  simulation::BuildingOptions options;
  options.kind = *kind;
  options.seed = FLAGS_seed;
  options.laps = FLAGS_laps;
  options.robot = robot->robot;
  auto building = simulation::GenerateBuilding(options);
  if (!building.ok()) return building.status();
  building->world.odometry = robot->odometry;
  building->world.imu = SmallImu();
  building->world.laser.mounting.x = 0.1;
  return std::move(building->world);
}

absl::StatusOr<simulation::World> LoadWorldWithRobot() {
  absl::StatusOr<simulation::World> world =
      simulation::LoadWorld(FLAGS_world_filename);
  if (!world.ok() || FLAGS_robot.empty()) return world;
  const auto preset = simulation::RobotPreset(FLAGS_robot);
  if (!preset.ok()) return preset.status();
  const double jitter = world->robot.jitter;
  world->robot = preset->robot;
  world->robot.jitter = jitter;
  simulation::OdometrySettings& odometry = world->odometry;
  odometry.rate = preset->odometry.rate;
  odometry.wheel_base = preset->odometry.wheel_base;
  odometry.ticks_per_meter = preset->odometry.ticks_per_meter;
  odometry.lateral_noise = preset->odometry.lateral_noise;
  return world;
}

// The world of the flags with its presets. A generated one or one with presets
// is passed through its text, so that the file written is the same world.
absl::StatusOr<simulation::World> MakeWorld() {
  const bool generated = !FLAGS_generate.empty();
  absl::StatusOr<simulation::World> world =
      generated ? GenerateWorld() : LoadWorldWithRobot();
  if (!world.ok()) return world;
  const std::string laser =
      generated && FLAGS_laser.empty() ? "ld06" : FLAGS_laser;
  if (!laser.empty()) {
    const Pose2 mounting = world->laser.mounting;
    const auto preset = simulation::LaserPreset(laser);
    if (!preset.ok()) return preset.status();
    world->laser = *preset;
    world->laser.mounting = mounting;
  }
  const std::string odometry =
      generated && FLAGS_odometry.empty() ? "fair" : FLAGS_odometry;
  if (!odometry.empty()) {
    const absl::Status status =
        simulation::ApplyOdometryPreset(odometry, FLAGS_seed, &*world);
    if (!status.ok()) return status;
  }
  if (!generated && FLAGS_laser.empty() && FLAGS_robot.empty() &&
      FLAGS_odometry.empty() && FLAGS_world_output_filename.empty()) {
    return world;
  }
  const std::string text = simulation::FormatWorld(*world);
  if (!FLAGS_world_output_filename.empty()) {
    const absl::Status status =
        WriteFileAtomically(FLAGS_world_output_filename, text);
    if (!status.ok()) return status;
  }
  return simulation::ParseWorld(text, world->name);
}

simulation::SimulationOptions OptionsByFlags() {
  simulation::SimulationOptions options;
  options.seed = FLAGS_seed;
  options.odometry_faults = FLAGS_odometry_faults;
  options.scan_stalls = FLAGS_scan_stalls;
  options.perfect = FLAGS_perfect;
  return options;
}

absl::Status Run() {
  const std::clock_t begin = std::clock();
  std::vector<std::string> outputs = {FLAGS_picture_filename, FLAGS_json,
                                      FLAGS_world_output_filename};
  if (!FLAGS_output_filestem.empty()) {
    outputs.push_back(FLAGS_output_filestem + ".tum");
  }
  absl::Status status = tools::CheckWritable(outputs);
  if (!status.ok()) return status;
  AtomicFileSet files;
  absl::StatusOr<simulation::World> world = MakeWorld();
  if (!world.ok()) return world.status();
  absl::StatusOr<std::unique_ptr<const simulation::Simulation>> created =
      simulation::Simulation::Create(*std::move(world), OptionsByFlags());
  if (!created.ok()) {
    return absl::Status(
        created.status().code(),
        absl::StrCat(
            FLAGS_generate.empty() ? FLAGS_world_filename : FLAGS_generate,
            ": ", created.status().message()));
  }
  const std::shared_ptr<const simulation::Simulation> simulation =
      *std::move(created);

  simulation::SimulationSummary summary;
  if (!FLAGS_output_filestem.empty()) {
    Progress progress("simulating scans", simulation->num_scans());
    simulation::SimulationOutputOptions output;
    output.filestem = FLAGS_output_filestem;
    output.carmen = FLAGS_carmen;
    output.bag = FLAGS_bag;
    output.mcap = FLAGS_mcap;
    output.db3 = FLAGS_db3;
    output.truth_map = FLAGS_truth_map;
    output.map_resolution = FLAGS_resolution;
    output.progress = [&progress](const int64_t scans) {
      progress.Update(scans);
    };
    status = simulation::WriteSimulation(simulation, output, &summary);
    progress.Finish();
    if (!status.ok()) return status;
  }
  if (!FLAGS_picture_filename.empty()) {
    status = simulation::WriteWorldPicture(*simulation, FLAGS_picture_pixels,
                                           FLAGS_picture_filename);
    if (!status.ok()) return status;
    summary.files.push_back(FLAGS_picture_filename);
  }
  if (!FLAGS_world_output_filename.empty()) {
    summary.files.push_back(FLAGS_world_output_filename);
  }
  const double cpu_seconds =
      static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const nlohmann::ordered_json report =
      Report(*simulation, summary, cpu_seconds);
  if (!FLAGS_json.empty()) {
    status = tools::WriteJson(report, FLAGS_json);
    if (!status.ok()) return status;
  }
  status = files.Commit();
  if (!status.ok()) return status;
  if (FLAGS_json != "-") {
    std::cout << absl::StrFormat(
        "%s, seed %d: %.0f m in %.0f s", simulation->world().name, FLAGS_seed,
        simulation->drive().length(), simulation->drive().duration());
    if (summary.scans > 0) {
      std::cout << absl::StrFormat(
          "; %d scans, %d odometry and %d IMU readings; %d sequential and %d "
          "loop relations; %.1f CPU s",
          summary.scans, summary.odometry_readings, summary.imu_readings,
          summary.sequential_relations, summary.loop_relations, cpu_seconds);
    }
    std::cout << "\n";
    for (const std::string& file : summary.files) {
      std::cout << "  " << file << "\n";
    }
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  namespace tools = cartographer_ext::tools;
  tools::CommandLine command_line(cartographer_ext::kDescription,
                                  "world_filename");
  namespace simulation = cartographer_ext::simulation;
  command_line.TakeOneOf("generate", simulation::BuildingNames());
  command_line.TakeOneOf("laser", simulation::LaserPresetNames());
  command_line.TakeOneOf("robot", simulation::RobotPresetNames());
  command_line.TakeOneOf("odometry", simulation::OdometryPresetNames());
  command_line.Parse(argc, argv);
  if (FLAGS_world_filename.empty() == FLAGS_generate.empty()) {
    return tools::UsageError(
        FLAGS_generate.empty()
            ? "give -world_filename or -generate"
            : "-world_filename and -generate exclude each other");
  }
  const absl::Status faults =
      simulation::CheckRandomFaults(FLAGS_odometry_faults);
  if (!faults.ok()) {
    return tools::UsageError(
        absl::StrCat("-odometry_faults: ", faults.message()));
  }
  if (FLAGS_laps < 1 || FLAGS_laps > simulation::kMaxLaps) {
    return tools::UsageError(absl::StrCat(
        "-laps=", FLAGS_laps, " is outside [1, ", simulation::kMaxLaps, "]"));
  }
  if (FLAGS_output_filestem.empty() && FLAGS_picture_filename.empty() &&
      FLAGS_json.empty() && FLAGS_world_output_filename.empty()) {
    return tools::UsageError(
        "nothing to write: give -output_filestem, -picture_filename, "
        "-world_output_filename or -json");
  }
  return tools::ExitCode(cartographer_ext::Run());
}
