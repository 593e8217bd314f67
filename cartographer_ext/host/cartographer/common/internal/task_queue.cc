// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/task_queue.h"

#include <utility>

#include "glog/logging.h"

namespace cartographer {
namespace common {

void TaskQueue::Add(std::shared_ptr<Task> task) {
  Task* const key = task.get();
  absl::MutexLock lock(&mutex_);
  const bool is_new = blocked_.emplace(key, std::move(task)).second;
  CHECK(is_new) << "a task was scheduled twice";
}

void TaskQueue::MarkReady(Task* const task) {
  absl::MutexLock lock(&mutex_);
  auto unblocked = blocked_.extract(task);
  CHECK(!unblocked.empty()) << "a task is ready that was never scheduled";
  ready_.push_back(std::move(unblocked.mapped()));
}

std::shared_ptr<Task> TaskQueue::Take() {
  absl::MutexLock lock(&mutex_,
                       absl::Condition(this, &TaskQueue::CanTakeOrEnd));
  std::shared_ptr<Task> task;
  if (!ready_.empty()) {
    task.swap(ready_.front());
    ready_.pop_front();
    ++num_taken_;
  }
  return task;
}

void TaskQueue::MarkDone() {
  absl::MutexLock lock(&mutex_);
  --num_taken_;
}

void TaskQueue::WaitUntilIdle() {
  absl::MutexLock lock(&mutex_, absl::Condition(this, &TaskQueue::IsIdle));
}

void TaskQueue::Close() {
  absl::MutexLock lock(&mutex_);
  closed_ = true;
}

bool TaskQueue::HasNoneBlocked() {
  absl::MutexLock lock(&mutex_);
  return blocked_.empty();
}

}  // namespace common
}  // namespace cartographer
