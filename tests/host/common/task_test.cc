// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/task.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "cartographer/common/thread_pool.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

// Runs tasks when the test says so.
class ManualPool : public ThreadPoolInterface {
 public:
  std::weak_ptr<Task> Schedule(std::unique_ptr<Task> task) override {
    std::shared_ptr<Task> shared(std::move(task));
    tasks_[shared.get()] = shared;
    SetThreadPool(shared.get());
    return shared;
  }

  bool IsReady(const std::weak_ptr<Task>& task) const {
    for (const Task* ready : ready_) {
      if (ready == task.lock().get()) return true;
    }
    return false;
  }

  // The oldest ready task.
  void RunNext() {
    Task* const task = ready_.front();
    ready_.erase(ready_.begin());
    Execute(task);
    tasks_.erase(task);
  }

  bool idle() const { return ready_.empty(); }

 private:
  void NotifyDependenciesCompleted(Task* task) override {
    ready_.push_back(task);
  }

  std::map<Task*, std::shared_ptr<Task>> tasks_;
  std::vector<Task*> ready_;
};

std::unique_ptr<Task> NewTask() { return std::unique_ptr<Task>(new Task); }

TEST(TaskTest, States) {
  ManualPool pool;
  auto task = NewTask();
  EXPECT_EQ(task->GetState(), Task::NEW);
  Task* const raw = task.get();
  Task::State while_running = Task::NEW;
  task->SetWorkItem(
      [raw, &while_running]() { while_running = raw->GetState(); });
  const std::shared_ptr<Task> scheduled = pool.Schedule(std::move(task)).lock();
  EXPECT_EQ(scheduled->GetState(), Task::DEPENDENCIES_COMPLETED);
  pool.RunNext();
  EXPECT_EQ(while_running, Task::RUNNING);
  EXPECT_EQ(scheduled->GetState(), Task::COMPLETED);
}

TEST(TaskTest, EmptyWork) {
  ManualPool pool;
  const auto task = pool.Schedule(NewTask());
  pool.RunNext();
  EXPECT_TRUE(task.expired());
}

TEST(TaskTest, WaitsForAllDependencies) {
  ManualPool pool;
  const auto a = pool.Schedule(NewTask());
  const auto b = pool.Schedule(NewTask());
  auto task = NewTask();
  task->AddDependency(a);
  task->AddDependency(b);
  const auto c = pool.Schedule(std::move(task));
  EXPECT_EQ(c.lock()->GetState(), Task::DISPATCHED);
  pool.RunNext();
  EXPECT_FALSE(pool.IsReady(c));
  pool.RunNext();
  EXPECT_TRUE(pool.IsReady(c));
  EXPECT_EQ(c.lock()->GetState(), Task::DEPENDENCIES_COMPLETED);
  pool.RunNext();
  EXPECT_TRUE(c.expired());
}

TEST(TaskTest, ExpiredAndCompletedDependenciesCountAsDone) {
  ManualPool pool;
  const auto done = pool.Schedule(NewTask());
  const std::shared_ptr<Task> kept = done.lock();
  pool.RunNext();
  std::weak_ptr<Task> expired;
  auto task = NewTask();
  task->AddDependency(expired);
  task->AddDependency(kept);
  const auto scheduled = pool.Schedule(std::move(task));
  EXPECT_TRUE(pool.IsReady(scheduled));
  pool.RunNext();
}

TEST(TaskTest, DependencyThatEndsBeforeScheduling) {
  ManualPool pool;
  const auto first = pool.Schedule(NewTask());
  auto task = NewTask();
  task->AddDependency(first);
  pool.RunNext();
  EXPECT_EQ(task->GetState(), Task::NEW);
  const auto second = pool.Schedule(std::move(task));
  EXPECT_TRUE(pool.IsReady(second));
  pool.RunNext();
}

TEST(TaskDeathTest, MisuseIsFatal) {
  ManualPool pool;
  const auto scheduled = pool.Schedule(NewTask()).lock();
  EXPECT_DEATH(scheduled->SetWorkItem([]() {}), "cannot change");
  EXPECT_DEATH(scheduled->AddDependency(std::weak_ptr<Task>()), "cannot get");
  EXPECT_DEATH(
      {
        Task task;
        task.AddDependency(scheduled);
        task.AddDependency(scheduled);
      },
      "added twice");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
