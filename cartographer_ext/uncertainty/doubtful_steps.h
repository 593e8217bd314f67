// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Steps of local SLAM whose match may be wrong: a word of local SLAM to the loop
// closure, by way of the context of the pose graph (pose_graph_context.h). What is
// not mentioned is as good as usual (path_uncertainty.h).
#ifndef CARTOGRAPHER_EXT_UNCERTAINTY_DOUBTFUL_STEPS_H_
#define CARTOGRAPHER_EXT_UNCERTAINTY_DOUBTFUL_STEPS_H_

#include <cstddef>
#include <cstdint>
#include <map>

#include "Eigen/Core"
#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace cartographer_ext {
namespace uncertainty {

// A part of PoseGraphContext. Bounded by kCapacity steps, the earliest are
// forgotten. Thread-safe.
class DoubtfulSteps {
 public:
  static constexpr size_t kCapacity = 100000;

  // `time`: of the node at the end of the step, host ticks. `covariance`: of what
  // is added to the usual error of the step, as in uncertain_pose.h. Of two
  // nodes of one time (two robots) both count.
  void Add(int64_t time, const Eigen::Matrix3d& covariance)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Zero where nothing is known.
  Eigen::Matrix3d CovarianceAt(int64_t time) const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  std::map<int64_t, Eigen::Matrix3d> steps_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace uncertainty
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_UNCERTAINTY_DOUBTFUL_STEPS_H_
