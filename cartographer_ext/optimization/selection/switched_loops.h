// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The loops disabled by the robust optimization problem of a pose graph, for
// reports. The problem records them in the context of the pose graph
// (common/pose_graph_context.h).
#ifndef CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_SWITCHED_LOOPS_H_
#define CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_SWITCHED_LOOPS_H_

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/common/loop_id.h"

namespace cartographer_ext {
namespace optimization {

// A disabled loop.
struct SwitchedLoop : LoopId {
  double chi2 = 0.;
  bool by_odometry_check = false;
};

// How many loops the poses contradict: by more than three standard deviations of
// a loop (`loop_sigma`) or by more than 0.1 rad; and how many of the motions by
// local SLAM between consecutive nodes (steps), by the same.
struct LoopsOffMap {
  int64_t loops = 0;
  int64_t off = 0;
  int64_t steps = 0;
  int64_t steps_off = 0;
};

// What putting loops in force at the end of a run has come to
// (dropin/loops_in_force.h).
struct LoopsPutInForce {
  LoopsOffMap before;
  LoopsOffMap after;  // of what was kept
  bool tried = false;
  bool relaxed = false;  // tried and kept
};

// Statistics of the selection.
struct SwitchedLoops {
  int64_t optimizations = 0;      // of the pose graph so far
  int64_t loops = 0;              // in the last one
  std::vector<SwitchedLoop> off;  // in the last one, in order of constraints
  double selection_cpu_seconds = 0.;  // of all
  double solution_cpu_seconds = 0.;   // of all, in the stock problem
  LoopsPutInForce in_force;           // the last time
  // Withdrawn at the end, as the map contradicts them (dropin/loops_in_force.h).
  std::set<LoopId> taken_back;
};

// A part of PoseGraphContext: counts over all optimizations, the loops of the
// last one. Thread-safe.
class SwitchedLoopRecorder {
 public:
  void Record(int64_t loops, std::vector<SwitchedLoop> off,
              double selection_cpu_seconds, double solution_cpu_seconds)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void Record(const LoopsPutInForce& in_force) ABSL_LOCKS_EXCLUDED(mutex_);
  void RecordTakenBack(std::set<LoopId> loops) ABSL_LOCKS_EXCLUDED(mutex_);
  SwitchedLoops Get() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  SwitchedLoops loops_ ABSL_GUARDED_BY(mutex_);
};

// One line per disabled loop, with a header line.
std::string SwitchedLoopsTable(const SwitchedLoops& loops);

// Parses such a table; an error names the first invalid line.
absl::StatusOr<std::vector<SwitchedLoop>> ParseSwitchedLoopsTable(
    absl::string_view table);

}  // namespace optimization
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_OPTIMIZATION_SELECTION_SWITCHED_LOOPS_H_
