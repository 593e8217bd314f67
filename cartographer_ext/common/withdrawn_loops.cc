// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/common/withdrawn_loops.h"

#include <algorithm>

namespace cartographer_ext {

constexpr size_t WithdrawnLoops::kCapacity;

void WithdrawnLoops::Add(const LoopId& id) {
  const absl::MutexLock lock(&mutex_);
  ids_.push_back(id);
  if (ids_.size() > kCapacity) ids_.pop_front();
}

bool WithdrawnLoops::Erase(const LoopId& id) {
  const absl::MutexLock lock(&mutex_);
  const auto erased = std::remove(ids_.begin(), ids_.end(), id);
  const bool was_withdrawn = erased != ids_.end();
  ids_.erase(erased, ids_.end());
  return was_withdrawn;
}

void WithdrawnLoops::EraseSubmap(const int trajectory_id,
                                 const int submap_index) {
  const absl::MutexLock lock(&mutex_);
  ids_.erase(std::remove_if(ids_.begin(), ids_.end(),
                            [=](const LoopId& id) {
                              return id.submap_trajectory == trajectory_id &&
                                     id.submap_index == submap_index;
                            }),
             ids_.end());
}

std::set<LoopId> WithdrawnLoops::All() const {
  const absl::MutexLock lock(&mutex_);
  return std::set<LoopId>(ids_.begin(), ids_.end());
}

}  // namespace cartographer_ext
