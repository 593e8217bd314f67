// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/testing/thread_pool_for_testing.h"

#include <utility>

#include "glog/logging.h"

namespace cartographer {
namespace common {
namespace testing {

ThreadPoolForTesting::ThreadPoolForTesting()
    : thread_([this]() {
        while (std::shared_ptr<Task> task = tasks_.Take()) {
          Execute(task.get());
          // Before we are idle: what the work item holds must not outlive that.
          task.reset();
          tasks_.MarkDone();
        }
      }) {}

ThreadPoolForTesting::~ThreadPoolForTesting() {
  tasks_.Close();
  thread_.join();
  CHECK(tasks_.HasNoneBlocked())
      << "tasks were left whose dependencies never ran";
}

std::weak_ptr<Task> ThreadPoolForTesting::Schedule(std::unique_ptr<Task> task) {
  const std::shared_ptr<Task> scheduled = std::move(task);
  tasks_.Add(scheduled);
  SetThreadPool(scheduled.get());
  return scheduled;
}

void ThreadPoolForTesting::NotifyDependenciesCompleted(Task* const task) {
  tasks_.MarkReady(task);
}

}  // namespace testing
}  // namespace common
}  // namespace cartographer
