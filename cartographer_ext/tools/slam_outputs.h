// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The outputs of cartographer_ext_slam, and their flags.
#ifndef CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_
#define CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_

#include <ostream>
#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/slam/slam_runner.h"

namespace cartographer_ext {
namespace tools {

// With a stem, every output without an explicit name is named after it.
void NameSlamOutputs(const std::string& stem);

// To be called at the start: CheckWritable for all of them, including the flags
// of slam_main.cc.
absl::Status CheckSlamOutputs();

// Writes the map and its side files, trajectories, tables and pictures, if
// named by a flag; not the report.
absl::Status WriteSlamResults(const evaluation::SlamRun& run);

// Whether a map is written, as a state, picture or occupancy grid.
bool WritesMap();

// Prints the names of the files, but for those that always lie beside a map.
void PrintSlamOutputs(std::ostream& out);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_
