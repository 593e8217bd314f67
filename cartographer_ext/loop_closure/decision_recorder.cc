// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_recorder.h"

#include <utility>

namespace cartographer_ext {
namespace loop_closure {
namespace {

// Of several records of a candidate, one that was withdrawn, only the last.
DecisionRecords KeepLast(const DecisionRecords& records) {
  std::map<int64_t, size_t> last;
  size_t position = 0;
  records.ForEach([&](const proto::LoopDecision& decision) {
    last[decision.candidate()] = position++;
  });
  DecisionRecords kept;
  position = 0;
  records.ForEach([&](const proto::LoopDecision& decision) {
    if (last[decision.candidate()] == position++) kept.Add(decision);
  });
  return kept;
}

}  // namespace

void DecisionRecorder::Start(const size_t capacity) {
  absl::MutexLock lock(&mutex_);
  started_ = true;
  capacity_ = capacity;
  num_dropped_ = 0;
  records_ = DecisionRecords();
  has_withdrawn_ = false;
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
  for (const proto::LoopDecision& decision : decisions) {
    if (records_.size() == capacity_) {
      ++num_dropped_;
      continue;
    }
    records_.Add(decision);
    if (decision.verdict() == proto::LoopDecision::UNDECIDED) {
      has_withdrawn_ = true;
    }
  }
}

void DecisionRecorder::TakeBack(const std::set<LoopId>& loops) {
  absl::MutexLock lock(&mutex_);
  if (!started_ || loops.empty()) return;
  Decisions taken;
  KeepLast(records_).ForEach([&](const proto::LoopDecision& decision) {
    LoopId id;
    id.submap_trajectory = decision.submap_trajectory_id();
    id.submap_index = decision.submap_index();
    id.node_trajectory = decision.node_trajectory_id();
    id.node_index = decision.node_index();
    if (decision.verdict() != proto::LoopDecision::ACCEPTED ||
        loops.count(id) == 0) {
      return;
    }
    taken.push_back(decision);
    taken.back().set_verdict(proto::LoopDecision::REJECTED);
    taken.back().set_reason(proto::LoopDecision::OFF_MAP);
  });
  // Even beyond the capacity: they are no more than were kept.
  for (const proto::LoopDecision& decision : taken) records_.Add(decision);
  has_withdrawn_ = has_withdrawn_ || !taken.empty();
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

DecisionRecords DecisionRecorder::Records() const {
  absl::MutexLock pending_lock(&pending_mutex_);
  Decisions undecided;
  for (const auto& entry : pending_) {
    const Decisions some = entry.second();
    undecided.insert(undecided.end(), some.begin(), some.end());
  }
  absl::MutexLock lock(&mutex_);
  DecisionRecords records = records_;
  for (const proto::LoopDecision& decision : undecided) records.Add(decision);
  return has_withdrawn_ ? KeepLast(records) : records;
}

int64_t DecisionRecorder::num_dropped() const {
  absl::MutexLock lock(&mutex_);
  return num_dropped_;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
