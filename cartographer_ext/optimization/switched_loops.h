// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the robust optimisation problem leaves its verdicts for whoever wants
// to report them: it lives deep inside the pose graph, which hands out nothing.
// Process-wide, for the optimisation run last; thread-safe.
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SWITCHED_LOOPS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SWITCHED_LOOPS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cartographer_ext {
namespace optimization {

struct SwitchedLoop {
  int submap_trajectory = 0;
  int submap_index = 0;
  int node_trajectory = 0;
  int node_index = 0;
  double chi2 = 0.;
  bool by_odometry_check = false;
};

struct SwitchedLoops {
  int64_t optimizations = 0;      // since the program started
  int64_t loops = 0;              // in the last one
  std::vector<SwitchedLoop> off;  // in the last one, in order of constraints
  double selection_cpu_seconds = 0.;  // of all
  double solution_cpu_seconds = 0.;   // of all, in the stock problem
};

SwitchedLoops LastSwitchedLoops();
void PublishSwitchedLoops(int64_t loops, std::vector<SwitchedLoop> off,
                          double selection_cpu_seconds,
                          double solution_cpu_seconds);
// Forgets everything, before another run in the same program.
void ResetSwitchedLoops();

// One line per loop switched off, with a heading.
std::string SwitchedLoopsTable(const SwitchedLoops& loops);

// The loops of such a table; an error which names the first bad line.
absl::StatusOr<std::vector<SwitchedLoop>> ParseSwitchedLoopsTable(
    absl::string_view table);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SWITCHED_LOOPS_H_
