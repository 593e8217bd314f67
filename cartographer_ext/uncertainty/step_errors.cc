// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/step_errors.h"

namespace cartographer_ext {
namespace uncertainty {

constexpr size_t StepErrors::kCapacity;

void StepErrors::Add(const int64_t time, const StepError& error) {
  const absl::MutexLock lock(&mutex_);
  const auto added = steps_.emplace(time, error);
  if (!added.second) {
    StepError& both = added.first->second;
    both.doubt += error.doubt;
    if (both.bridged.has_value() && error.bridged.has_value()) {
      *both.bridged += *error.bridged;
    } else if (error.bridged.has_value()) {
      both.bridged = error.bridged;
    }
  }
  if (steps_.size() > kCapacity) steps_.erase(steps_.begin());
}

StepError StepErrors::At(const int64_t time) const {
  const absl::MutexLock lock(&mutex_);
  const auto found = steps_.find(time);
  return found == steps_.end() ? StepError() : found->second;
}

}  // namespace uncertainty
}  // namespace cartographer_ext
