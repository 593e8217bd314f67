// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/work_queue.h"

#include <utility>

#include "absl/memory/memory.h"
#include "cartographer/common/task.h"
#include "cartographer/common/time.h"
#include "glog/logging.h"

namespace cartographer {
namespace mapping {

WorkQueue::WorkQueue(common::ThreadPoolInterface* const thread_pool,
                     std::function<void(WorkItem::Result)> barrier_handler,
                     std::function<void(size_t)> on_size)
    : thread_pool_(thread_pool),
      barrier_handler_(std::move(barrier_handler)),
      on_size_(std::move(on_size)) {}

WorkQueue::~WorkQueue() {
  absl::MutexLock lock(&mutex_);
  CHECK(!active_) << "work is in progress";
}

void WorkQueue::Add(const std::function<WorkItem::Result()>& task) {
  bool start = false;
  {
    absl::MutexLock lock(&mutex_);
    items_.push_back(WorkItem{std::chrono::steady_clock::now(), task});
    ReportSize();
    start = !active_;
    active_ = true;
  }
  if (start) {
    auto pool_task = absl::make_unique<common::Task>();
    pool_task->SetWorkItem([this]() { Resume(); });
    thread_pool_->Schedule(std::move(pool_task));
  }
}

void WorkQueue::Resume() {
  while (true) {
    std::function<WorkItem::Result()> task;
    {
      absl::MutexLock lock(&mutex_);
      if (items_.empty()) {
        active_ = false;
        // From here on the queue may have been destroyed.
        return;
      }
      task = std::move(items_.front().task);
      items_.pop_front();
      ReportSize();
    }
    const WorkItem::Result result = task();
    if (result != WorkItem::Result::kDoNotRunOptimization) {
      task = nullptr;
      barrier_handler_(result);
      return;
    }
  }
}

void WorkQueue::WaitUntilIdle() {
  absl::MutexLock lock(&mutex_);
  const auto idle = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return !active_;
  };
  mutex_.Await(absl::Condition(&idle));
}

void WorkQueue::ReportSize() const {
  if (on_size_ != nullptr) on_size_(items_.size());
}

double WorkQueue::DelaySeconds() const {
  absl::MutexLock lock(&mutex_);
  if (items_.empty()) {
    return 0.;
  }
  return common::ToSeconds(std::chrono::steady_clock::now() -
                           items_.front().time);
}

}  // namespace mapping
}  // namespace cartographer
