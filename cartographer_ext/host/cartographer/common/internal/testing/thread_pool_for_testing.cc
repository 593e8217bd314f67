// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/testing/thread_pool_for_testing.h"

#include <utility>

#include "glog/logging.h"

namespace cartographer {
namespace common {
namespace testing {

ThreadPoolForTesting::ThreadPoolForTesting()
    : thread_([this]() { DoWork(); }) {}

ThreadPoolForTesting::~ThreadPoolForTesting() {
  {
    absl::MutexLock lock(&mutex_);
    running_ = false;
  }
  thread_.join();
  absl::MutexLock lock(&mutex_);
  CHECK(waiting_.empty()) << "tasks were left whose dependencies never ran";
}

std::weak_ptr<Task> ThreadPoolForTesting::Schedule(std::unique_ptr<Task> task) {
  const std::shared_ptr<Task> shared(std::move(task));
  {
    absl::MutexLock lock(&mutex_);
    CHECK(waiting_.emplace(shared.get(), shared).second);
  }
  SetThreadPool(shared.get());
  return shared;
}

void ThreadPoolForTesting::NotifyDependenciesCompleted(Task* const task) {
  absl::MutexLock lock(&mutex_);
  const auto found = waiting_.find(task);
  CHECK(found != waiting_.end());
  ready_.push_back(std::move(found->second));
  waiting_.erase(found);
}

void ThreadPoolForTesting::WaitUntilIdle() {
  const auto idle = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return ready_.empty() && !executing_;
  };
  absl::MutexLock lock(&mutex_);
  mutex_.Await(absl::Condition(&idle));
}

void ThreadPoolForTesting::DoWork() {
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
      executing_ = true;
    }
    Execute(task.get());
    // Before we are idle: what the work item holds must not outlive that.
    task.reset();
    absl::MutexLock lock(&mutex_);
    executing_ = false;
  }
}

}  // namespace testing
}  // namespace common
}  // namespace cartographer
