// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Drift of local SLAM of each trajectory: the noise of its path
// (path_uncertainty.h) as estimated by loop closure during the run, starting
// from the prior of the configuration. Kept in the PoseGraphContext, so that
// all code that weighs local SLAM against loops or odometry uses the same
// values:
//
//   const DriftEstimate drift =
//       context->Get<uncertainty::DriftModel>()->Of(trajectory_id);
//   ... drift.mean.translation_per_metre ...
//
// `mean` is the best estimate, for weights. `upper` is an upper bound, for
// tests that must not reject true loops while few loops are known. Both are the
// prior times DriftFactors. `common` are the errors that are constant along the
// run.
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

// Drift of one trajectory.
struct DriftEstimate {
  PathNoiseOptions mean;
  PathNoiseOptions upper;
  CommonDrift common;
  // Number of cycles used; 0: only the prior is known.
  int num_cycles = 0;
};

// "local SLAM of trajectory 0 drifts by 0.063 m and 0.29 deg (standard
// deviations) in 10 m, estimated from 12 cycles", of the newest trajectory with
// an estimate; empty where there is none.
std::string ToText(const std::map<int, DriftEstimate>& drifts);

// Estimates by trajectory; the prior where there is none.
class DriftModel {
 public:
  // Prior for every trajectory without an estimate. Before the first call it is
  // the default of PathNoiseOptions.
  void SetPrior(const PathNoiseOptions& prior) ABSL_LOCKS_EXCLUDED(mutex_);
  void Set(int trajectory_id, const DriftEstimate& estimate)
      ABSL_LOCKS_EXCLUDED(mutex_);
  DriftEstimate Of(int trajectory_id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Estimates of all trajectories that have one.
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
