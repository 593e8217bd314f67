// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_THREAD_POOL_H_
#define CARTOGRAPHER_COMMON_THREAD_POOL_H_

#include <deque>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/container/flat_hash_map.h"
#include "absl/synchronization/mutex.h"
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

  std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task)
      ABSL_LOCKS_EXCLUDED(mutex_) override;

 private:
  void DoWork() ABSL_LOCKS_EXCLUDED(mutex_);
  void NotifyDependenciesCompleted(Task* task)
      ABSL_LOCKS_EXCLUDED(mutex_) override;

  absl::Mutex mutex_;
  bool running_ ABSL_GUARDED_BY(mutex_) = true;
  std::vector<std::thread> threads_;
  std::deque<std::shared_ptr<Task>> ready_ ABSL_GUARDED_BY(mutex_);
  absl::flat_hash_map<Task*, std::shared_ptr<Task>> waiting_
      ABSL_GUARDED_BY(mutex_);
};

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_THREAD_POOL_H_
