// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/internal/task_queue.h"

#include <atomic>
#include <memory>
#include <thread>

#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

TEST(TaskQueueTest, FirstReadyFirstOut) {
  TaskQueue queue;
  const auto first = std::make_shared<Task>();
  const auto second = std::make_shared<Task>();
  queue.Add(first);
  queue.Add(second);
  EXPECT_FALSE(queue.HasNoneBlocked());
  queue.MarkReady(second.get());
  queue.MarkReady(first.get());
  EXPECT_TRUE(queue.HasNoneBlocked());
  EXPECT_EQ(queue.Take(), second);
  EXPECT_EQ(queue.Take(), first);
}

TEST(TaskQueueTest, ClosingLetsWorkersFinishWhatIsReady) {
  TaskQueue queue;
  const auto ready = std::make_shared<Task>();
  queue.Add(ready);
  queue.Add(std::make_shared<Task>());
  queue.MarkReady(ready.get());
  queue.Close();
  EXPECT_EQ(queue.Take(), ready);
  EXPECT_EQ(queue.Take(), nullptr);
}

TEST(TaskQueueTest, IdleOnceTakenTasksAreDone) {
  TaskQueue queue;
  const auto task = std::make_shared<Task>();
  queue.Add(task);
  queue.MarkReady(task.get());
  std::atomic<bool> done(false);
  std::thread worker([&]() {
    while (queue.Take() != nullptr) {
      done = true;
      queue.MarkDone();
    }
  });
  queue.WaitUntilIdle();
  EXPECT_TRUE(done);
  queue.Close();
  worker.join();
}

TEST(TaskQueueDeathTest, Misuse) {
  TaskQueue queue;
  const auto task = std::make_shared<Task>();
  queue.Add(task);
  EXPECT_DEATH(queue.Add(task), "scheduled twice");
  Task other;
  EXPECT_DEATH(queue.MarkReady(&other), "never scheduled");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
