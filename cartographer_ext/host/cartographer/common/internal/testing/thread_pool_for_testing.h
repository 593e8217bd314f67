// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_INTERNAL_TESTING_THREAD_POOL_FOR_TESTING_H_
#define CARTOGRAPHER_COMMON_INTERNAL_TESTING_THREAD_POOL_FOR_TESTING_H_

#include <memory>
#include <thread>

#include "cartographer/common/internal/task_queue.h"
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

  std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task) override;

  // Returns when no task is ready or running.
  void WaitUntilIdle() { tasks_.WaitUntilIdle(); }

 private:
  void NotifyDependenciesCompleted(Task* task) override;

  TaskQueue tasks_;
  std::thread thread_;
};

}  // namespace testing
}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_INTERNAL_TESTING_THREAD_POOL_FOR_TESTING_H_
