// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_THREAD_POOL_H_
#define CARTOGRAPHER_COMMON_THREAD_POOL_H_

#include <memory>
#include <thread>
#include <vector>

#include "cartographer/common/internal/task_queue.h"
#include "cartographer/common/task.h"

namespace cartographer {
namespace common {

class ThreadPoolInterface {
 public:
  ThreadPoolInterface() {}
  virtual ~ThreadPoolInterface() {}

  // Takes the task and runs it once its dependencies are done; ready tasks run
  // first in, first out. Never blocks on work and never runs it inline.
  virtual std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task) = 0;

 protected:
  void Execute(Task* task);
  void SetThreadPool(Task* task);

 private:
  friend class Task;

  virtual void NotifyDependenciesCompleted(Task* task) = 0;
};

// A fixed number of threads, at reduced priority so that real-time work in the
// same process comes first. The destructor runs what is ready, then joins.
class ThreadPool : public ThreadPoolInterface {
 public:
  // `num_threads` > 0.
  explicit ThreadPool(int num_threads);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task) override;

 private:
  void Work();
  void NotifyDependenciesCompleted(Task* task) override;

  TaskQueue tasks_;
  std::vector<std::thread> threads_;
};

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_THREAD_POOL_H_
