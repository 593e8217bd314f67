// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the records of matched scans go. Local SLAM is deep inside the host,
// out of reach of who runs it, so there is one recorder for the process, like
// the host's metrics. It keeps nothing until somebody starts it. Thread-safe.
#ifndef CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORDER_H_
#define CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORDER_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer_ext/match_record.pb.h"

namespace cartographer_ext {
namespace front_end {

class MatchRecorder {
 public:
  static MatchRecorder* Global();

  // Forgets everything and keeps up to `capacity` records from now on; what
  // comes after is counted only. Builders count from 0 again.
  void Start(size_t capacity) ABSL_LOCKS_EXCLUDED(mutex_);
  void Stop() ABSL_LOCKS_EXCLUDED(mutex_);
  bool started() const ABSL_LOCKS_EXCLUDED(mutex_);

  // The number of a new builder.
  int AddBuilder() ABSL_LOCKS_EXCLUDED(mutex_);
  void Record(const proto::MatchRecord& record) ABSL_LOCKS_EXCLUDED(mutex_);

  std::vector<proto::MatchRecord> All() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Records that the capacity left out.
  int64_t num_left_out() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  size_t capacity_ ABSL_GUARDED_BY(mutex_) = 0;
  bool started_ ABSL_GUARDED_BY(mutex_) = false;
  int num_builders_ ABSL_GUARDED_BY(mutex_) = 0;
  int64_t num_left_out_ ABSL_GUARDED_BY(mutex_) = 0;
  std::vector<proto::MatchRecord> records_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORDER_H_
