// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Steps of local SLAM whose match may be wrong, or that bridge a gap between
// scans: a word of local SLAM to the loop closure, by way of the context of the pose
// graph (pose_graph_context.h). What is not mentioned is as good as usual
// (path_uncertainty.h).
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_STEP_ERRORS_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_STEP_ERRORS_H_

#include <cstddef>
#include <cstdint>
#include <map>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/uncertainty/step_error.h"

namespace cartographer_ext {
namespace uncertainty {

// A part of PoseGraphContext. Bounded by kCapacity steps, the earliest are
// forgotten. Thread-safe.
class StepErrors {
 public:
  static constexpr size_t kCapacity = 100000;

  // `time`: of the node at the end of the step, host ticks. Of two nodes of one
  // time (two robots) both count.
  void Add(int64_t time, const StepError& error) ABSL_LOCKS_EXCLUDED(mutex_);
  // The usual one where nothing is known.
  StepError At(int64_t time) const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  std::map<int64_t, StepError> steps_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_STEP_ERRORS_H_
