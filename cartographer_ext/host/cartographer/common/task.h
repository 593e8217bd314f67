// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_COMMON_TASK_H_
#define CARTOGRAPHER_COMMON_TASK_H_

#include <functional>
#include <memory>
#include <set>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace cartographer {
namespace common {

class ThreadPoolInterface;

// A piece of work for a thread pool that may depend on other tasks.
//
// NEW -> Schedule -> DISPATCHED -> all dependencies done ->
// DEPENDENCIES_COMPLETED -> RUNNING -> COMPLETED.
//
// A dependency remembers its dependents by plain pointer: a task that was given
// a live dependency must be scheduled some day. Work items must never wait for
// other tasks, since a pool may have a single thread.
class Task {
 public:
  friend class ThreadPoolInterface;

  using WorkItem = std::function<void()>;
  enum State { NEW, DISPATCHED, DEPENDENCIES_COMPLETED, RUNNING, COMPLETED };

  Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  // Warns when the task was scheduled but has not completed.
  ~Task();

  State GetState() ABSL_LOCKS_EXCLUDED(mutex_);

  // Fatal unless NEW. An empty work item is allowed.
  void SetWorkItem(const WorkItem& work_item) ABSL_LOCKS_EXCLUDED(mutex_);

  // Fatal unless NEW, and when `dependency` was added before. An expired
  // dependency counts as done.
  void AddDependency(std::weak_ptr<Task> dependency)
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // False when already completed, so that `dependent` need not wait.
  bool AddDependent(Task* dependent) ABSL_LOCKS_EXCLUDED(mutex_);
  void Execute() ABSL_LOCKS_EXCLUDED(mutex_);
  void SetThreadPool(ThreadPoolInterface* thread_pool)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDependencyCompleted() ABSL_LOCKS_EXCLUDED(mutex_);

  absl::Mutex mutex_;
  WorkItem work_item_ ABSL_GUARDED_BY(mutex_);
  ThreadPoolInterface* thread_pool_ ABSL_GUARDED_BY(mutex_) = nullptr;
  State state_ ABSL_GUARDED_BY(mutex_) = NEW;
  int num_open_dependencies_ ABSL_GUARDED_BY(mutex_) = 0;
  std::set<Task*> dependents_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace common
}  // namespace cartographer

#endif  // CARTOGRAPHER_COMMON_TASK_H_
