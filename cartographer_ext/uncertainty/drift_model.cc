// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_model.h"

#include <cmath>

#include "absl/strings/str_format.h"
#include "cartographer_ext/common/pose2.h"

namespace cartographer_ext {
namespace uncertainty {

std::string ToText(const std::map<int, DriftEstimate>& drifts) {
  for (auto drift = drifts.rbegin(); drift != drifts.rend(); ++drift) {
    const DriftEstimate& estimate = drift->second;
    if (estimate.num_cycles == 0) continue;
    constexpr double kMetres = 10.;
    return absl::StrFormat(
        "local SLAM of trajectory %d drifts by %.3f m and %.2f deg (standard "
        "deviations) in %.0f m, estimated from %d cycles",
        drift->first, estimate.mean.translation_per_metre * std::sqrt(kMetres),
        RadToDeg(estimate.mean.rotation_per_metre * std::sqrt(kMetres)),
        kMetres, estimate.num_cycles);
  }
  return "";
}

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
