// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_INTERNAL_TESTING_THREAD_POOL_FOR_TESTING_H_
#define CARTOGRAPHER_COMMON_INTERNAL_TESTING_THREAD_POOL_FOR_TESTING_H_

#include <deque>
#include <map>
#include <memory>
#include <thread>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/thread_pool.h"

namespace cartographer {
namespace common {
namespace testing {

// A pool with one thread whose owner can wait until there is nothing left to
// do.
class ThreadPoolForTesting : public ThreadPoolInterface {
 public:
  ThreadPoolForTesting();
  ~ThreadPoolForTesting() override;

  std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task)
      ABSL_LOCKS_EXCLUDED(mutex_) override;

  // Returns when no task is ready or running.
  void WaitUntilIdle() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  void DoWork() ABSL_LOCKS_EXCLUDED(mutex_);
  void NotifyDependenciesCompleted(Task* task)
      ABSL_LOCKS_EXCLUDED(mutex_) override;

  absl::Mutex mutex_;
  bool running_ ABSL_GUARDED_BY(mutex_) = true;
  bool executing_ ABSL_GUARDED_BY(mutex_) = false;
  std::deque<std::shared_ptr<Task>> ready_ ABSL_GUARDED_BY(mutex_);
  std::map<Task*, std::shared_ptr<Task>> waiting_ ABSL_GUARDED_BY(mutex_);
  std::thread thread_;
};

}  // namespace testing
}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_INTERNAL_TESTING_THREAD_POOL_FOR_TESTING_H_
