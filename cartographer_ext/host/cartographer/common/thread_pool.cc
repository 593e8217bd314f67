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

namespace {

// Lowers the priority so that real-time work in the same process comes first.
// On Linux this affects the calling thread only.
void LowerPriorityOfThisThread() {
#ifdef __linux__
  constexpr int kIncrement = 10;
  // A result of -1 is an error only with errno: the new value may be -1.
  errno = 0;
  const int new_value = nice(kIncrement);
  PCHECK(new_value != -1 || errno == 0);
#endif
}

}  // namespace

ThreadPool::ThreadPool(const int num_threads) {
  CHECK_GT(num_threads, 0) << "a thread pool without threads";
  while (static_cast<int>(threads_.size()) < num_threads) {
    threads_.emplace_back(&ThreadPool::Work, this);
  }
}

ThreadPool::~ThreadPool() {
  tasks_.Close();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

std::weak_ptr<Task> ThreadPool::Schedule(std::unique_ptr<Task> task) {
  const std::shared_ptr<Task> scheduled = std::move(task);
  tasks_.Add(scheduled);
  // Calls back at once when there is nothing to wait for.
  SetThreadPool(scheduled.get());
  return scheduled;
}

void ThreadPool::NotifyDependenciesCompleted(Task* const task) {
  tasks_.MarkReady(task);
}

void ThreadPool::Work() {
  LowerPriorityOfThisThread();
  while (const std::shared_ptr<Task> task = tasks_.Take()) {
    Execute(task.get());
    tasks_.MarkDone();
  }
}

}  // namespace common
}  // namespace cartographer
