// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How often the loops of a pose graph are mistaken for others: a word of the
// loop closure to the optimisation, by way of the context of the pose graph.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_LOOP_AMBIGUITY_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_LOOP_AMBIGUITY_H_

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/types/optional.h"

namespace cartographer_ext {
namespace uncertainty {

// A part of PoseGraphContext. Thread-safe.
class LoopAmbiguity {
 public:
  // Of the matches that were verified, the share at a place that only looks the
  // same, 0 to 1.
  void Set(const double share_wrong) ABSL_LOCKS_EXCLUDED(mutex_) {
    const absl::MutexLock lock(&mutex_);
    share_wrong_ = share_wrong;
  }
  // Unknown where our loop closure did not say it.
  absl::optional<double> share_wrong() const ABSL_LOCKS_EXCLUDED(mutex_) {
    const absl::MutexLock lock(&mutex_);
    return share_wrong_;
  }

 private:
  mutable absl::Mutex mutex_;
  absl::optional<double> share_wrong_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_LOOP_AMBIGUITY_H_
