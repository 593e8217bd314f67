// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The tasks of a thread pool between being scheduled and being done.
// Thread-safe.
#ifndef CARTOGRAPHER_COMMON_INTERNAL_TASK_QUEUE_H_
#define CARTOGRAPHER_COMMON_INTERNAL_TASK_QUEUE_H_

#include <deque>
#include <memory>
#include <unordered_map>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/task.h"

namespace cartographer {
namespace common {

class TaskQueue {
 public:
  // Keeps a task until it is ready; it must be new.
  void Add(std::shared_ptr<Task> task) ABSL_LOCKS_EXCLUDED(mutex_);
  // The dependencies of an added task are done.
  void MarkReady(Task* task) ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits for the next ready task, first in, first out. Null when there is none
  // and the queue was closed. A worker that has dealt with a task says so.
  std::shared_ptr<Task> Take() ABSL_LOCKS_EXCLUDED(mutex_);
  void MarkDone() ABSL_LOCKS_EXCLUDED(mutex_);

  // Waits until no task is ready or with a worker.
  void WaitUntilIdle() ABSL_LOCKS_EXCLUDED(mutex_);
  // Lets workers end once no task is ready.
  void Close() ABSL_LOCKS_EXCLUDED(mutex_);
  // Whether no task waits for its dependencies.
  bool HasNoneBlocked() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  bool IsIdle() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return ready_.empty() && num_taken_ == 0;
  }
  bool CanTakeOrEnd() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return closed_ || !ready_.empty();
  }

  absl::Mutex mutex_;
  std::unordered_map<Task*, std::shared_ptr<Task>> blocked_
      ABSL_GUARDED_BY(mutex_);
  std::deque<std::shared_ptr<Task>> ready_ ABSL_GUARDED_BY(mutex_);
  int num_taken_ ABSL_GUARDED_BY(mutex_) = 0;
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_INTERNAL_TASK_QUEUE_H_
