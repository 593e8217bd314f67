// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The outputs of cartographer_ext_slam, and their flags.
#ifndef CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_
#define CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_

#include <functional>
#include <ostream>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_ext/io/occupancy_map.h"
#include "cartographer_ext/map/map_graph.h"
#include "cartographer_ext/slam/slam_runner.h"

namespace cartographer_ext {
namespace tools {

// With a stem, every output without an explicit name is named after it.
void NameSlamOutputs(const std::string& stem);

// To be called at the start: CheckWritable for all of them, including the flags
// of slam_main.cc.
absl::Status CheckSlamOutputs();

// The map of a run, with what the run knows of its nodes and loops.
evaluation::MapGraph MarkedGraph(const evaluation::SlamRun& run);

// Writes the state and its side files, trajectories and tables, if named by a
// flag; `graph` is that of MarkedGraph.
absl::Status WriteSlamResults(const evaluation::SlamRun& run,
                              const evaluation::MapGraph& graph);

// Writes occupancy map and picture, if named by a flag. `paint` is given the
// resolution, metres per cell.
absl::Status WritePaintedMap(
    const evaluation::MapGraph& graph,
    const std::function<absl::StatusOr<io::OccupancyMap>(double)>& paint);

// Whether a map is written, as a state, picture or occupancy grid.
bool WritesMap();

// Prints the names of the files, but for those that always lie beside a map.
void PrintSlamOutputs(std::ostream& out);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_
