// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What cartographer_ext_slam writes of a run, and the flags that name it.
#ifndef CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_
#define CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_

#include <ostream>
#include <string>

#include "absl/status/status.h"
#include "cartographer_ext/slam/slam_runner.h"

namespace cartographer_ext {
namespace tools {

// With a stem, every output that has no name of its own is named after it.
void NameSlamOutputs(const std::string& stem);

// Before the work: CheckWritable of all of them, those flags included that
// slam_main.cc defines.
absl::Status CheckSlamOutputs();

// The map and what lies beside it, trajectories, tables and pictures, each
// where a flag names it; not the report.
absl::Status WriteSlamResults(const evaluation::SlamRun& run);

// The files that a user looks for first.
void PrintSlamOutputs(std::ostream& out);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_SLAM_OUTPUTS_H_
