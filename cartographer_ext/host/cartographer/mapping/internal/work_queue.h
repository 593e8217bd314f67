// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Work that is done one item after the other, in the order of arrival, on a
// thread pool.
//
// Every item may end with a barrier: the queue then pauses and calls the
// barrier handler, which arranges, usually at some later time and on some other
// thread, for Resume(). Nothing blocks a thread of the pool meanwhile. The
// outcome of a series of items thus depends on their order only, however many
// threads there are and whenever the items arrive.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_WORK_QUEUE_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_WORK_QUEUE_H_

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/thread_pool.h"

namespace cartographer {
namespace mapping {

struct WorkItem {
  enum class Result {
    kDoNotRunOptimization,  // go on
    kRunOptimization,       // barrier: collect the constraints and optimise
    kCollectConstraints,    // barrier: only collect the constraints
  };

  std::chrono::steady_clock::time_point time;
  std::function<Result()> task;
};

class WorkQueue {
 public:
  // The handler is called on the pool, without locks, with the result that is
  // not kDoNotRunOptimization; it must cause exactly one Resume(). `on_size`,
  // if any, is told the number of waiting items whenever it changes, in this
  // order and under the lock: it must not call the queue.
  WorkQueue(common::ThreadPoolInterface* thread_pool,
            std::function<void(WorkItem::Result)> barrier_handler,
            std::function<void(size_t)> on_size = nullptr);
  // Nothing may be running: see WaitUntilIdle.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  // Never blocks on work.
  void Add(const std::function<WorkItem::Result()>& task)
      ABSL_LOCKS_EXCLUDED(mutex_);

  // Ends a barrier and works on, on the calling thread, up to the next one.
  void Resume() ABSL_LOCKS_EXCLUDED(mutex_);

  // Blocks until there is nothing left to do. Not for threads of the pool.
  void WaitUntilIdle() ABSL_LOCKS_EXCLUDED(mutex_);

  // How long the oldest waiting item has waited.
  double DelaySeconds() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  void ReportSize() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  common::ThreadPoolInterface* const thread_pool_;
  const std::function<void(WorkItem::Result)> barrier_handler_;
  const std::function<void(size_t)> on_size_;
  mutable absl::Mutex mutex_;
  std::deque<WorkItem> items_ ABSL_GUARDED_BY(mutex_);
  // True from the first item until the queue has run empty, barriers included.
  bool active_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_WORK_QUEUE_H_
