// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_recorder.h"

#include <algorithm>
#include <utility>

namespace cartographer_ext {
namespace loop_closure {

void DecisionRecorder::Start(const size_t capacity) {
  absl::MutexLock lock(&mutex_);
  started_ = true;
  capacity_ = capacity;
  num_dropped_ = 0;
  decisions_.clear();
}

void DecisionRecorder::Stop() {
  absl::MutexLock lock(&mutex_);
  started_ = false;
}

bool DecisionRecorder::started() const {
  absl::MutexLock lock(&mutex_);
  return started_;
}

void DecisionRecorder::Record(const Decisions& decisions) {
  absl::MutexLock lock(&mutex_);
  if (!started_) return;
  const size_t room = capacity_ - std::min(capacity_, decisions_.size());
  const size_t kept = std::min(room, decisions.size());
  decisions_.insert(decisions_.end(), decisions.begin(),
                    decisions.begin() + static_cast<std::ptrdiff_t>(kept));
  num_dropped_ += static_cast<int64_t>(decisions.size() - kept);
}

int64_t DecisionRecorder::AddPending(std::function<Decisions()> undecided) {
  absl::MutexLock lock(&pending_mutex_);
  pending_.emplace(next_pending_, std::move(undecided));
  return next_pending_++;
}

void DecisionRecorder::RemovePending(const int64_t id) {
  absl::MutexLock lock(&pending_mutex_);
  pending_.erase(id);
}

DecisionRecorder::Decisions DecisionRecorder::All() const {
  absl::MutexLock pending_lock(&pending_mutex_);
  Decisions undecided;
  for (const auto& entry : pending_) {
    const Decisions some = entry.second();
    undecided.insert(undecided.end(), some.begin(), some.end());
  }
  absl::MutexLock lock(&mutex_);
  Decisions all = decisions_;
  all.insert(all.end(), undecided.begin(), undecided.end());
  return all;
}

int64_t DecisionRecorder::num_dropped() const {
  absl::MutexLock lock(&mutex_);
  return num_dropped_;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
