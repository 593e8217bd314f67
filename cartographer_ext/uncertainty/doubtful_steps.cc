// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/doubtful_steps.h"

namespace cartographer_ext {
namespace uncertainty {

constexpr size_t DoubtfulSteps::kCapacity;

void DoubtfulSteps::Add(const int64_t time, const Eigen::Matrix3d& covariance) {
  const absl::MutexLock lock(&mutex_);
  const auto added = steps_.emplace(time, covariance);
  if (!added.second) added.first->second += covariance;
  if (steps_.size() > kCapacity) steps_.erase(steps_.begin());
}

Eigen::Matrix3d DoubtfulSteps::CovarianceAt(const int64_t time) const {
  const absl::MutexLock lock(&mutex_);
  const auto found = steps_.find(time);
  return found == steps_.end() ? Eigen::Matrix3d(Eigen::Matrix3d::Zero())
                               : found->second;
}

}  // namespace uncertainty
}  // namespace cartographer_ext
