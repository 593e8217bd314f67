// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/task.h"

#include <utility>

#include "cartographer/common/thread_pool.h"
#include "glog/logging.h"

namespace cartographer {
namespace common {

Task::~Task() {
  // Nobody else can reach the task any more, but the analysis wants the lock.
  absl::MutexLock lock(&mutex_);
  if (state_ != NEW && state_ != COMPLETED) {
    LOG(WARNING) << "A task goes away after it was scheduled and before it has "
                    "completed.";
  }
}

Task::State Task::GetState() {
  absl::MutexLock lock(&mutex_);
  return state_;
}

void Task::SetWorkItem(const WorkItem& work_item) {
  absl::MutexLock lock(&mutex_);
  CHECK_EQ(state_, NEW) << "the work of a scheduled task cannot change";
  work_item_ = work_item;
}

void Task::AddDependency(std::weak_ptr<Task> dependency) {
  const std::shared_ptr<Task> alive = dependency.lock();
  {
    absl::MutexLock lock(&mutex_);
    CHECK_EQ(state_, NEW) << "a scheduled task cannot get dependencies";
    if (alive == nullptr) return;
    // Must precede the registration with the other task, so that the count
    // never drops below 0.
    ++num_open_dependencies_;
  }
  if (!alive->AddDependent(this)) OnDependencyCompleted();
}

bool Task::AddDependent(Task* const dependent) {
  absl::MutexLock lock(&mutex_);
  if (state_ == COMPLETED) return false;
  CHECK(dependents_.insert(dependent).second)
      << "the same dependency was added twice";
  return true;
}

void Task::SetThreadPool(ThreadPoolInterface* const thread_pool) {
  absl::MutexLock lock(&mutex_);
  CHECK_EQ(state_, NEW) << "a task can be scheduled once";
  thread_pool_ = thread_pool;
  state_ = DISPATCHED;
  if (num_open_dependencies_ > 0) return;
  state_ = DEPENDENCIES_COMPLETED;
  thread_pool_->NotifyDependenciesCompleted(this);
}

void Task::OnDependencyCompleted() {
  absl::MutexLock lock(&mutex_);
  CHECK(state_ == NEW || state_ == DISPATCHED);
  --num_open_dependencies_;
  if (num_open_dependencies_ > 0 || state_ == NEW) return;
  state_ = DEPENDENCIES_COMPLETED;
  thread_pool_->NotifyDependenciesCompleted(this);
}

void Task::Execute() {
  WorkItem work_item;
  {
    absl::MutexLock lock(&mutex_);
    CHECK_EQ(state_, DEPENDENCIES_COMPLETED);
    state_ = RUNNING;
    work_item = std::move(work_item_);
  }
  if (work_item) work_item();

  std::set<Task*> dependents;
  {
    absl::MutexLock lock(&mutex_);
    state_ = COMPLETED;
    dependents.swap(dependents_);
  }
  // The dependent tasks are alive because they wait for this one.
  for (Task* const dependent : dependents) dependent->OnDependencyCompleted();
}

}  // namespace common
}  // namespace cartographer
