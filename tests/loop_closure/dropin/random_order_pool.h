// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A thread pool that runs its ready tasks in random order, with a few threads:
// whatever orders the host allows come up sooner or later.
#ifndef TESTS_LOOP_CLOSURE_DROPIN_RANDOM_ORDER_POOL_H_
#define TESTS_LOOP_CLOSURE_DROPIN_RANDOM_ORDER_POOL_H_

#include <map>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/task.h"
#include "cartographer/common/thread_pool.h"
#include "cartographer_ext/common/random.h"

namespace cartographer_ext {
namespace loop_closure {
namespace test {

class RandomOrderPool : public cartographer::common::ThreadPoolInterface {
 public:
  using Task = cartographer::common::Task;

  RandomOrderPool(const int num_threads, const uint64_t seed) : random_(seed) {
    for (int i = 0; i < num_threads; ++i) {
      threads_.emplace_back([this]() { DoWork(); });
    }
  }
  ~RandomOrderPool() override {
    {
      absl::MutexLock lock(&mutex_);
      running_ = false;
    }
    for (std::thread& thread : threads_) thread.join();
  }

  std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task)
      ABSL_LOCKS_EXCLUDED(mutex_) override {
    const std::shared_ptr<Task> shared(std::move(task));
    {
      absl::MutexLock lock(&mutex_);
      waiting_.emplace(shared.get(), shared);
    }
    SetThreadPool(shared.get());
    return shared;
  }

 private:
  void NotifyDependenciesCompleted(Task* const task)
      ABSL_LOCKS_EXCLUDED(mutex_) override {
    absl::MutexLock lock(&mutex_);
    const auto found = waiting_.find(task);
    ready_.push_back(std::move(found->second));
    waiting_.erase(found);
  }

  void DoWork() ABSL_LOCKS_EXCLUDED(mutex_) {
    const auto has_news = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
      return !ready_.empty() || !running_;
    };
    for (;;) {
      std::shared_ptr<Task> task;
      {
        absl::MutexLock lock(&mutex_);
        mutex_.Await(absl::Condition(&has_news));
        if (ready_.empty()) return;
        const size_t choice =
            static_cast<size_t>(random_.Uniform() * ready_.size());
        std::swap(ready_[choice], ready_.back());
        task = std::move(ready_.back());
        ready_.pop_back();
      }
      Execute(task.get());
    }
  }

  absl::Mutex mutex_;
  Random random_ ABSL_GUARDED_BY(mutex_);
  bool running_ ABSL_GUARDED_BY(mutex_) = true;
  std::vector<std::shared_ptr<Task>> ready_ ABSL_GUARDED_BY(mutex_);
  std::map<Task*, std::shared_ptr<Task>> waiting_ ABSL_GUARDED_BY(mutex_);
  std::vector<std::thread> threads_;
};

}  // namespace test
}  // namespace loop_closure
}  // namespace cartographer_ext

#endif  // TESTS_LOOP_CLOSURE_DROPIN_RANDOM_ORDER_POOL_H_
