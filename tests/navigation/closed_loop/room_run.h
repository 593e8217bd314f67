// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A small furnished room with its map, for the tests of the closed loop.
#ifndef CARTOGRAPHER_EXT_TESTS_NAVIGATION_CLOSED_LOOP_ROOM_RUN_H_
#define CARTOGRAPHER_EXT_TESTS_NAVIGATION_CLOSED_LOOP_ROOM_RUN_H_

#include <unistd.h>

#include <memory>
#include <string>

#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/map/host_map.h"
#include "cartographer_ext/navigation/closed_loop/navigation_run.h"
#include "cartographer_ext/simulation/world_parser.h"
#include "cartographer_ext/simulation/world_source.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "glog/logging.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace navigation {

constexpr char kRoomWorld[] = R"(world room
rectangle 0 0 9 6
rectangle 4 0 4.6 1.5
rectangle 6.5 4.8 7.5 6
pillar 2 4.5 0.2
laser beams=180 fov=360 noise=0.01 rate=10
odometry rate=20 phase=0.02 noise=0.004 scale_sigma=0.01
robot radius=0.25 speed=0.7 acceleration=0.5 turn_rate=0.8 turn_acceleration=1.5
start 1 1 0
wait 1
goto 3 2.5
goto 7.5 2.5
goto 7.5 1
goto 7.5 3.5
goto 3 3.5
goto 1 3
goto 1 1
)";

struct Room {
  simulation::World world;
  evaluation::SlamConfiguration configuration;  // of the localisation
  std::string pbstream_filename;
  io::OccupancyMap map;

  // Mapped once for all tests of a program.
  static const Room& Get() {
    static const Room* const room = new Room(Make());
    return *room;
  }

  // Not run.
  NavigationRunOptions Options() const {
    NavigationRunOptions options;
    options.pbstream_filename = pbstream_filename;
    options.goals = {{6., 0.}, {0., 0.}};
    options.max_seconds = 120.;
    return options;
  }

  static evaluation::SlamConfiguration Load(const std::string& name) {
    auto configuration =
        evaluation::LoadSlamConfiguration({"configuration_files"}, name);
    CHECK(configuration.ok()) << configuration.status();
    return *configuration;
  }

 private:
  static Room Make() {
    Room room;
    auto world = simulation::ParseWorld(kRoomWorld, "room.world");
    CHECK(world.ok()) << world.status();
    room.world = *world;
    auto simulation = simulation::Simulation::Create(*world, {});
    CHECK(simulation.ok()) << simulation.status();
    simulation::WorldSource source(*std::move(simulation));
    const evaluation::SlamConfiguration mapping = Load("default.lua");
    room.configuration = Load("localization.lua");
    auto run = evaluation::RunSlam(mapping, &source, {});
    CHECK(run.ok()) << run.status();
    room.pbstream_filename = testing::TempDir() + "/room_run_" +
                             std::to_string(getpid()) + ".pbstream";
    CHECK(evaluation::WritePbstream(run->map_builder.get(),
                                    room.pbstream_filename)
              .ok());
    auto map = evaluation::PaintHostMap(*run->map_builder->pose_graph(), 0.05);
    CHECK(map.ok()) << map.status();
    room.map = *map;
    return room;
  }
};

}  // namespace navigation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TESTS_NAVIGATION_CLOSED_LOOP_ROOM_RUN_H_
