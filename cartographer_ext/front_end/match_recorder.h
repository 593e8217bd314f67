// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The records of the scans that local SLAM matched, a part of the context of
// their pose graph (common/pose_graph_context.h). Keeps nothing until it is
// started. Thread-safe.
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

// Records of matched scans, see above. Thread-safe.
class MatchRecorder {
 public:
  // Drops all records and keeps up to `capacity` from now on; later ones are
  // only counted.
  void Start(size_t capacity) ABSL_LOCKS_EXCLUDED(mutex_);
  void Stop() ABSL_LOCKS_EXCLUDED(mutex_);
  bool started() const ABSL_LOCKS_EXCLUDED(mutex_);

  // The number of a new local trajectory builder, from 0.
  int AddBuilder() ABSL_LOCKS_EXCLUDED(mutex_);
  void Record(const proto::MatchRecord& record) ABSL_LOCKS_EXCLUDED(mutex_);

  std::vector<proto::MatchRecord> All() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Records beyond the capacity.
  int64_t num_dropped() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  size_t capacity_ ABSL_GUARDED_BY(mutex_) = 0;
  bool started_ ABSL_GUARDED_BY(mutex_) = false;
  int num_builders_ ABSL_GUARDED_BY(mutex_) = 0;
  int64_t num_dropped_ ABSL_GUARDED_BY(mutex_) = 0;
  std::vector<proto::MatchRecord> records_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_MATCH_RECORDER_H_
