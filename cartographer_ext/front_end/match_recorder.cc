// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/match_recorder.h"

namespace cartographer_ext {
namespace front_end {

void MatchRecorder::Start(const size_t capacity) {
  absl::MutexLock lock(&mutex_);
  capacity_ = capacity;
  started_ = true;
  num_dropped_ = 0;
  records_.clear();
}

void MatchRecorder::Stop() {
  absl::MutexLock lock(&mutex_);
  started_ = false;
  records_.clear();
  records_.shrink_to_fit();
}

bool MatchRecorder::started() const {
  absl::MutexLock lock(&mutex_);
  return started_;
}

int MatchRecorder::AddBuilder() {
  absl::MutexLock lock(&mutex_);
  return num_builders_++;
}

void MatchRecorder::Record(const proto::MatchRecord& record) {
  absl::MutexLock lock(&mutex_);
  if (!started_) return;
  if (records_.size() < capacity_) {
    records_.push_back(record);
  } else {
    ++num_dropped_;
  }
}

std::vector<proto::MatchRecord> MatchRecorder::All() const {
  absl::MutexLock lock(&mutex_);
  return records_;
}

int64_t MatchRecorder::num_dropped() const {
  absl::MutexLock lock(&mutex_);
  return num_dropped_;
}

}  // namespace front_end
}  // namespace cartographer_ext
