// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_model.h"

namespace cartographer_ext {
namespace uncertainty {

void DriftModel::SetPrior(const PathNoiseOptions& prior) {
  absl::MutexLock lock(&mutex_);
  prior_ = prior;
}

void DriftModel::Set(const int trajectory_id, const DriftEstimate& estimate) {
  absl::MutexLock lock(&mutex_);
  estimates_[trajectory_id] = estimate;
}

DriftEstimate DriftModel::Of(const int trajectory_id) const {
  absl::MutexLock lock(&mutex_);
  const auto found = estimates_.find(trajectory_id);
  if (found != estimates_.end()) return found->second;
  DriftEstimate estimate;
  estimate.mean = prior_;
  estimate.upper = prior_;
  estimate.common = PriorCommonDrift(prior_);
  return estimate;
}

std::map<int, DriftEstimate> DriftModel::All() const {
  absl::MutexLock lock(&mutex_);
  return estimates_;
}

void DriftModel::DeleteTrajectory(const int trajectory_id) {
  absl::MutexLock lock(&mutex_);
  estimates_.erase(trajectory_id);
}

}  // namespace uncertainty
}  // namespace cartographer_ext
