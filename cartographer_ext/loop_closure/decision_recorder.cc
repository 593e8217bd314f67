// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/decision_recorder.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/status/statusor.h"
#include "cartographer_ext/loop_closure/decision_log.h"
#include "glog/logging.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

constexpr size_t kChunkBytes = 1 << 20;

// Of several records of a candidate, one that was withdrawn, only the last.
void KeepLast(DecisionRecorder::Decisions* const decisions) {
  std::map<int64_t, size_t> last;
  for (size_t i = 0; i < decisions->size(); ++i) {
    last[(*decisions)[i].candidate()] = i;
  }
  DecisionRecorder::Decisions kept;
  for (size_t i = 0; i < decisions->size(); ++i) {
    if (last[(*decisions)[i].candidate()] == i) {
      kept.push_back(std::move((*decisions)[i]));
    }
  }
  *decisions = std::move(kept);
}

}  // namespace

void DecisionRecorder::Start(const size_t capacity) {
  absl::MutexLock lock(&mutex_);
  started_ = true;
  capacity_ = capacity;
  num_dropped_ = 0;
  chunks_.clear();
  num_records_ = 0;
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
    if (num_records_ == capacity_) {
      ++num_dropped_;
      continue;
    }
    if (chunks_.empty() || chunks_.back().size() >= kChunkBytes) {
      chunks_.emplace_back();
      chunks_.back().reserve(kChunkBytes + kChunkBytes / 64);
    }
    AppendDecision(decision, &chunks_.back());
    if (decision.verdict() == proto::LoopDecision::UNDECIDED) {
      has_withdrawn_ = true;
    }
    ++num_records_;
  }
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
  Decisions all;
  all.reserve(num_records_ + undecided.size());
  for (const std::string& chunk : chunks_) {
    absl::StatusOr<Decisions> decisions = ParseDecisions(chunk);
    CHECK(decisions.ok()) << decisions.status();  // written above
    std::move(decisions->begin(), decisions->end(), std::back_inserter(all));
  }
  std::move(undecided.begin(), undecided.end(), std::back_inserter(all));
  if (has_withdrawn_) KeepLast(&all);
  return all;
}

int64_t DecisionRecorder::num_dropped() const {
  absl::MutexLock lock(&mutex_);
  return num_dropped_;
}

}  // namespace loop_closure
}  // namespace cartographer_ext
