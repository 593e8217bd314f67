// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How much local SLAM of each trajectory drifts: the noise of its path
// (path_uncertainty.h) as loop closure estimates it from the run, beginning
// with the prior of the configuration. Kept in the PoseGraphContext, so that
// whoever weighs local SLAM against loops or odometry reads the same figures:
//
//   const DriftEstimate drift =
//       context->Get<uncertainty::DriftModel>()->Of(trajectory_id);
//   ... drift.mean.translation_per_metre ...
//
// `mean` is the best estimate, for weights. `upper` bounds the drift from above
// while few loops are known, for tests that would lock out true loops. Both are
// the prior times DriftFactors. `common` is what is the same all along the run.
//
// Thread-safe.
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_MODEL_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_MODEL_H_

#include <map>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/uncertainty/path_uncertainty.h"

namespace cartographer_ext {
namespace uncertainty {

struct DriftEstimate {
  PathNoiseOptions mean;
  PathNoiseOptions upper;
  CommonDrift common;
  // Independent pieces of evidence; 0: nothing is known but the prior.
  int num_cycles = 0;
};

// "local SLAM of trajectory 0 drifts by 0.063 m and 0.29 deg (standard
// deviations) in 10 m, estimated from 12 cycles", the newest trajectory of
// which something is known; empty where there is none.
std::string ToText(const std::map<int, DriftEstimate>& drifts);

class DriftModel {
 public:
  // Of every trajectory that nothing else is known of. Before the first call
  // it is the default of PathNoiseOptions.
  void SetPrior(const PathNoiseOptions& prior) ABSL_LOCKS_EXCLUDED(mutex_);
  void Set(int trajectory_id, const DriftEstimate& estimate)
      ABSL_LOCKS_EXCLUDED(mutex_);
  DriftEstimate Of(int trajectory_id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Of all trajectories of which something is known.
  std::map<int, DriftEstimate> All() const ABSL_LOCKS_EXCLUDED(mutex_);
  void DeleteTrajectory(int trajectory_id) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  PathNoiseOptions prior_ ABSL_GUARDED_BY(mutex_);
  std::map<int, DriftEstimate> estimates_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_DRIFT_MODEL_H_
