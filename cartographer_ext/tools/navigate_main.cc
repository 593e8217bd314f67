// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
// LINK: closed_loop
//
// cartographer_ext_navigate: drives a simulated robot over a finished map, in
// closed loop with localisation, and measures how well.
#include <cstdint>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/types/optional.h"
#include "cartographer_ext/common/atomic_file.h"
#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/map/pbstream_map.h"
#include "cartographer_ext/navigation/closed_loop/goals.h"
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"
#include "cartographer_ext/navigation/closed_loop/run_animation.h"
#include "cartographer_ext/navigation/closed_loop/run_report.h"
#include "cartographer_ext/navigation/closed_loop/shadow_localization.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/tools/command_line.h"
#include "gflags/gflags.h"
#include "nlohmann/json.hpp"

DEFINE_string(pbstream_filename, "",
              "The finished map: localisation runs in it, and it is planned on "
              "unless -map_filename is given.");
DEFINE_string(map_filename, "",
              "Plan on this occupancy map instead (YAML beside its PGM), for "
              "example one that was edited; in the frame of the pbstream.");
DEFINE_string(world_filename, "",
              "World file of the place: what the laser sees and the robot can "
              "run into, robot and sensors. Its drive is not used but for the "
              "start.");
DEFINE_string(goals, "auto",
              "Goals in the map frame, metres: X,Y;X,Y - or auto: places that "
              "cover the map, drawn from the seed, the last one the start.");
DEFINE_int32(num_goals, 4, "Number of goals for -goals auto.");
DEFINE_uint64(seed, 1, "Chooses goals, noise, slip, people and obstacles.");
DEFINE_int32(obstacles, 0, "Things put in the robot's path.");
DEFINE_int32(crossings, 0, "People who cross its path suddenly.");
DEFINE_int32(doors, 0,
             "Passages on its path that close; every goal stays reachable.");
DEFINE_bool(attentive_people, true,
            "The people of the world stop rather than walk into a robot that "
            "they see; otherwise they walk on whatever is there. Those who "
            "cross suddenly never look.");
DEFINE_string(
    configuration_directory, "",
    "Folders that are searched for Lua files, comma separated. Empty: "
    "the files installed with this command.");
DEFINE_string(configuration_basename, "localization.lua",
              "Lua file for the localisation.");
DEFINE_string(other_configuration_basename, "",
              "Lua file of a second localisation that gets the very same "
              "readings afterwards, for comparison.");
DEFINE_double(resolution, 0.05, "Metres a cell of the map.");
DEFINE_double(max_seconds, 1800., "Simulated time after which it is over.");
DEFINE_string(picture_filename, "", "Output: PNG of map, path and goals.");
DEFINE_string(animation_filename, "",
              "Output: the drive as an animation (one HTML file).");
DEFINE_string(json, "", "Output: figures as JSON; - is standard output.");

namespace cartographer_ext {
namespace {

constexpr int kMaxGoals = 1000;

constexpr char kDescription[] =
    R"(Drives a simulated robot to goals on a finished map: localisation, A*, dynamic
window approach, all in closed loop, measured against the truth.

  cartographer_ext_slam -input_filename=configuration_files/worlds/office.world \
      -seed=101 -configuration_basename=default.lua -pbstream_filename=office.pbstream
  cartographer_ext_navigate -pbstream_filename=office.pbstream \
      -world_filename=configuration_files/worlds/office.world \
      -goals=auto -seed=1 -obstacles=5 -crossings=3 \
      -picture_filename=drive.png -animation_filename=drive.html -json=-

What is measured and how: docs/navigation.md.)";

absl::StatusOr<io::OccupancyMap> ReadMap() {
  if (!FLAGS_map_filename.empty()) {
    return io::ReadOccupancyMap(FLAGS_map_filename);
  }
  const auto pbstream = io::ReadPbstream(FLAGS_pbstream_filename);
  if (!pbstream.ok()) return pbstream.status();
  auto map = evaluation::PaintPbstreamMap(*pbstream, FLAGS_resolution);
  if (!map.ok()) {
    return absl::Status(
        map.status().code(),
        absl::StrCat(FLAGS_pbstream_filename, ": ", map.status().message()));
  }
  return map;
}

absl::StatusOr<navigation::NavigationRunOptions> ReadOptions() {
  navigation::NavigationRunOptions options;
  options.pbstream_filename = FLAGS_pbstream_filename;
  options.seed = FLAGS_seed;
  if (FLAGS_goals != "auto") {
    auto goals = navigation::ParseGoals(FLAGS_goals);
    if (!goals.ok()) {
      return tools::WrongUsage(absl::InvalidArgumentError(
          absl::StrCat("-goals: ", goals.status().message())));
    }
    options.goals = *std::move(goals);
  }
  options.num_goals = FLAGS_num_goals;
  options.obstacles = FLAGS_obstacles;
  options.crossings = FLAGS_crossings;
  options.doors = FLAGS_doors;
  options.people.attentive = FLAGS_attentive_people;
  options.max_seconds = FLAGS_max_seconds;
  options.record_frames = !FLAGS_animation_filename.empty();
  options.keep_readings = !FLAGS_other_configuration_basename.empty();
  return options;
}

absl::Status Run() {
  const auto options = ReadOptions();
  if (!options.ok()) return options.status();
  absl::Status status = tools::CheckWritable(
      {FLAGS_picture_filename, FLAGS_animation_filename, FLAGS_json});
  if (!status.ok()) return status;
  const std::vector<std::string> directories =
      tools::ConfigurationDirectories(FLAGS_configuration_directory);
  const auto configuration = evaluation::LoadSlamConfiguration(
      directories, FLAGS_configuration_basename);
  if (!configuration.ok()) return configuration.status();
  absl::optional<evaluation::SlamConfiguration> other;
  if (!FLAGS_other_configuration_basename.empty()) {
    auto loaded = evaluation::LoadSlamConfiguration(
        directories, FLAGS_other_configuration_basename);
    if (!loaded.ok()) return loaded.status();
    other = *std::move(loaded);
  }
  const auto world = simulation::LoadWorld(FLAGS_world_filename);
  if (!world.ok()) return world.status();
  const auto map = ReadMap();
  if (!map.ok()) return map.status();
  const auto run =
      navigation::RunNavigation(*world, *map, *configuration, *options);
  if (!run.ok()) return run.status();

  const std::string title =
      absl::StrCat(world->name, ", seed ", FLAGS_seed, ": ", run->reached(),
                   " of ", run->goals.size(), " goals");
  AtomicFileSet files;
  if (!FLAGS_picture_filename.empty()) {
    status = navigation::WriteRunPicture(*run, title, FLAGS_picture_filename);
    if (!status.ok()) return status;
  }
  if (!FLAGS_animation_filename.empty()) {
    status =
        navigation::WriteRunAnimation(*run, title, FLAGS_animation_filename);
    if (!status.ok()) return status;
  }
  nlohmann::ordered_json json = {{"world", world->name},
                                 {"seed", FLAGS_seed},
                                 {"configuration", configuration->name}};
  json.update(navigation::ToJson(*run));
  if (other.has_value()) {
    const auto shadow =
        navigation::LocalizeAgain(*run, *other, FLAGS_pbstream_filename);
    if (!shadow.ok()) return shadow.status();
    json["other_localization"] = navigation::ToJson(*shadow, run->seconds);
    json["other_localization"]["configuration"] = other->name;
  }
  if (FLAGS_json != "-") std::cout << navigation::ToText(*run);
  if (!FLAGS_json.empty()) status = tools::WriteJson(json, FLAGS_json);
  return status.ok() ? files.Commit() : status;
}

}  // namespace
}  // namespace cartographer_ext

int main(int argc, char** argv) {
  namespace tools = cartographer_ext::tools;
  tools::CommandLine command_line(cartographer_ext::kDescription,
                                  "pbstream_filename");
  command_line.Parse(argc, argv);
  if (FLAGS_pbstream_filename.empty()) {
    return tools::UsageError("-pbstream_filename is missing");
  }
  if (FLAGS_world_filename.empty()) {
    return tools::UsageError("-world_filename is missing");
  }
  if (FLAGS_num_goals < 1 || FLAGS_num_goals > cartographer_ext::kMaxGoals) {
    return tools::UsageError(absl::StrCat("-num_goals must be at least 1 and ",
                                          "at most ",
                                          cartographer_ext::kMaxGoals));
  }
  if (!(FLAGS_max_seconds >= 1.)) {
    return tools::UsageError("-max_seconds must be at least 1");
  }
  return tools::ExitCode(cartographer_ext::Run());
}
