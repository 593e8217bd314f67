// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A simulated run as files, all named <filestem> plus
//   .clf             CARMEN log: odometry and scans (no IMU in that format)
//   .bag             ROS 1 bag with the IMU, where bags are compiled in
//   .mcap, .db3      ROS 2 recordings with the IMU
//   .tum             true pose of the robot at every scan
//   .relations       true relations, sequential and loop pairs
//   .truth.loops.csv the loop pairs alone
//   .places.csv      visits of the marked places
//   .distances.csv   key distances and the scans that see their ends
//   .faults.csv      odometry faults: kind, from, to, size
//   .truth.pgm/.yaml the ideal map
// The columns are described in docs/world_format.md.
#ifndef CARTOGRAPHER_EXT_SIMULATION_SIMULATION_OUTPUT_H_
#define CARTOGRAPHER_EXT_SIMULATION_SIMULATION_OUTPUT_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cartographer_ext/simulation/simulation.h"

namespace cartographer_ext {
namespace simulation {

struct SimulationOutputOptions {
  std::string filestem;
  bool carmen = true;
  bool bag = false;
  bool mcap = false;
  bool db3 = false;
  bool truth_map = true;
  double map_resolution = 0.05;  // metres per cell
  // Called with the number of scans written so far.
  std::function<void(int64_t)> progress;
};

struct SimulationSummary {
  int64_t scans = 0;
  int64_t odometry_readings = 0;
  int64_t imu_readings = 0;
  int64_t beams = 0;
  int64_t sequential_relations = 0;
  int64_t loop_relations = 0;
  int64_t place_visits = 0;
  std::vector<std::string> files;
};

// Every file is complete or absent. An error names the file.
absl::Status WriteSimulation(std::shared_ptr<const Simulation> simulation,
                             const SimulationOutputOptions& options,
                             SimulationSummary* summary);

}  // namespace simulation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SIMULATION_SIMULATION_OUTPUT_H_
