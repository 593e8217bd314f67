// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/thread_pool.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

#include "glog/logging.h"

namespace cartographer {
namespace common {

void ThreadPoolInterface::Execute(Task* const task) { task->Execute(); }

void ThreadPoolInterface::SetThreadPool(Task* const task) {
  task->SetThreadPool(this);
}

ThreadPool::ThreadPool(const int num_threads) {
  CHECK_GT(num_threads, 0) << "ThreadPool requires a positive num_threads!";
  threads_.reserve(num_threads);
  for (int i = 0; i != num_threads; ++i) {
    threads_.emplace_back([this]() { DoWork(); });
  }
}

ThreadPool::~ThreadPool() {
  {
    absl::MutexLock lock(&mutex_);
    running_ = false;
  }
  for (std::thread& thread : threads_) thread.join();
}

std::weak_ptr<Task> ThreadPool::Schedule(std::unique_ptr<Task> task) {
  const std::shared_ptr<Task> shared(std::move(task));
  {
    absl::MutexLock lock(&mutex_);
    CHECK(waiting_.emplace(shared.get(), shared).second);
  }
  // Calls back at once when there is nothing to wait for.
  SetThreadPool(shared.get());
  return shared;
}

void ThreadPool::NotifyDependenciesCompleted(Task* const task) {
  absl::MutexLock lock(&mutex_);
  const auto found = waiting_.find(task);
  CHECK(found != waiting_.end());
  ready_.push_back(std::move(found->second));
  waiting_.erase(found);
}

void ThreadPool::DoWork() {
#ifdef __linux__
  // On Linux this concerns the calling thread alone. -1 is a legal answer to
  // programs that were started at -11.
  errno = 0;
  PCHECK(nice(10) != -1 || errno == 0);
#endif
  const auto has_news = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return !ready_.empty() || !running_;
  };
  for (;;) {
    std::shared_ptr<Task> task;
    {
      absl::MutexLock lock(&mutex_);
      mutex_.Await(absl::Condition(&has_news));
      if (ready_.empty()) return;
      task = std::move(ready_.front());
      ready_.pop_front();
    }
    Execute(task.get());
  }
}

}  // namespace common
}  // namespace cartographer
