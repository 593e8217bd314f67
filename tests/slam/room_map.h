// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A small stored map for tests: the room of room_source.h as the host maps it,
// with submaps small enough that the second lap closes loops.
#ifndef TESTS_SLAM_ROOM_MAP_H_
#define TESTS_SLAM_ROOM_MAP_H_

#include <string>

#include "cartographer_ext/configuration/slam_configuration.h"
#include "cartographer_ext/io/pbstream/pbstream_reader.h"
#include "cartographer_ext/slam/slam_runner.h"
#include "glog/logging.h"
#include "tests/slam/room_source.h"

namespace cartographer_ext {
namespace test {

// Lua of the map; `more` is added before it is returned.
inline std::string RoomLua(const std::string& more = "") {
  return "include \"common_2d.lua\"\n"
         "TRAJECTORY_BUILDER_2D.submaps.num_range_data = 15\n"
         "POSE_GRAPH.optimize_every_n_nodes = 30\n"
         "POSE_GRAPH.constraint_builder.sampling_ratio = 0.3\n"
         "POSE_GRAPH.constraint_builder.fast_correlative_scan_matcher."
         "linear_search_window = 1.\n" +
         more +
         "\nreturn { map_builder = MAP_BUILDER, trajectory_builder = "
         "TRAJECTORY_BUILDER }\n";
}

inline evaluation::SlamConfiguration RoomConfiguration(
    const std::string& more = "") {
  auto configuration = evaluation::ParseSlamConfiguration(
      {"configuration_files"}, "room.lua", RoomLua(more));
  CHECK(configuration.ok()) << configuration.status();
  return *configuration;
}

// `filename` is written and left.
inline io::Pbstream MakeRoomMap(const std::string& filename,
                                const int num_scans = 520) {
  RoomSource source(num_scans);
  const auto run = evaluation::RunSlam(RoomConfiguration(), &source, {});
  CHECK(run.ok()) << run.status();
  CHECK(evaluation::WritePbstream(run->map_builder.get(), filename).ok());
  auto pbstream = io::ReadPbstream(filename);
  CHECK(pbstream.ok()) << pbstream.status();
  return *std::move(pbstream);
}

}  // namespace test
}  // namespace cartographer_ext

#endif  // TESTS_SLAM_ROOM_MAP_H_
