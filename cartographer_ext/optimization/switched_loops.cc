// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/optimization/switched_loops.h"

#include <mutex>
#include <utility>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace optimization {
namespace {

std::mutex* Mutex() {
  static std::mutex* const mutex = new std::mutex;
  return mutex;
}

SwitchedLoops* Loops() {
  static SwitchedLoops* const loops = new SwitchedLoops;
  return loops;
}

}  // namespace

SwitchedLoops LastSwitchedLoops() {
  std::lock_guard<std::mutex> lock(*Mutex());
  return *Loops();
}

void PublishSwitchedLoops(const int64_t loops, std::vector<SwitchedLoop> off,
                          const double cpu_seconds) {
  std::lock_guard<std::mutex> lock(*Mutex());
  ++Loops()->optimizations;
  Loops()->loops = loops;
  Loops()->off = std::move(off);
  Loops()->selection_cpu_seconds += cpu_seconds;
}

std::string SwitchedLoopsTable(const SwitchedLoops& loops) {
  std::string table =
      "submap_trajectory,submap,node_trajectory,node,chi2,reason\n";
  for (const SwitchedLoop& loop : loops.off) {
    absl::StrAppend(&table, loop.submap_trajectory, ",", loop.submap_index, ",",
                    loop.node_trajectory, ",", loop.node_index, ",", loop.chi2,
                    ",", loop.by_odometry_check ? "odometry" : "consensus",
                    "\n");
  }
  return table;
}

}  // namespace optimization
}  // namespace cartographer_ext
