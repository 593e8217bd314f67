// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Collects the records of loop decisions: a part of PoseGraphContext, through
// which a program can access the decisions of the constraint builder inside the
// host. Keeps nothing until it is started. Thread-safe.
#ifndef CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORDER_H_
#define CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORDER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/common/loop_id.h"
#include "cartographer_ext/loop_closure/decision_records.h"
#include "cartographer_ext/loop_decision.pb.h"

namespace cartographer_ext {
namespace loop_closure {

// Records of decisions, see above. Thread-safe.
class DecisionRecorder {
 public:
  using Decisions = std::vector<proto::LoopDecision>;

  // Drops all records and keeps up to `capacity` from now on; further ones are
  // only counted.
  void Start(size_t capacity) ABSL_LOCKS_EXCLUDED(mutex_);
  void Stop() ABSL_LOCKS_EXCLUDED(mutex_);
  bool started() const ABSL_LOCKS_EXCLUDED(mutex_);

  void Record(const Decisions& decisions) ABSL_LOCKS_EXCLUDED(mutex_);
  // Of these loops, what was accepted is rejected: the map contradicts it.
  void TakeBack(const std::set<LoopId>& loops) ABSL_LOCKS_EXCLUDED(mutex_);
  // Registers a source of undecided candidates. `undecided` is called without
  // holding any lock of the recorder. Returns a number for `RemovePending`,
  // after which it is no longer called.
  int64_t AddPending(std::function<Decisions()> undecided)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void RemovePending(int64_t id) ABSL_LOCKS_EXCLUDED(mutex_);

  // The records of all candidates in the order of their verdicts, followed by
  // the currently undecided ones. Of a candidate that was withdrawn, the last.
  DecisionRecords Records() const ABSL_LOCKS_EXCLUDED(mutex_);
  // The same, parsed.
  Decisions All() const { return Records().Parsed(); }
  // Number of records beyond the capacity.
  int64_t num_dropped() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  // Held while the functions in `pending_` are called, and before `mutex_`.
  mutable absl::Mutex pending_mutex_ ABSL_ACQUIRED_BEFORE(mutex_);
  size_t capacity_ ABSL_GUARDED_BY(mutex_) = 0;
  bool started_ ABSL_GUARDED_BY(mutex_) = false;
  int64_t num_dropped_ ABSL_GUARDED_BY(mutex_) = 0;
  DecisionRecords records_ ABSL_GUARDED_BY(mutex_);
  bool has_withdrawn_ ABSL_GUARDED_BY(mutex_) = false;
  std::map<int64_t, std::function<Decisions()>> pending_
      ABSL_GUARDED_BY(pending_mutex_);
  int64_t next_pending_ ABSL_GUARDED_BY(pending_mutex_) = 0;
};

}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_LOOP_CLOSURE_DECISION_RECORDER_H_
