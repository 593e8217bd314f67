// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/common/thread_pool.h"

#include <atomic>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "absl/synchronization/blocking_counter.h"
#include "absl/synchronization/mutex.h"
#include "cartographer/common/internal/testing/thread_pool_for_testing.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace common {
namespace {

std::unique_ptr<Task> TaskWith(const Task::WorkItem& work) {
  std::unique_ptr<Task> task(new Task);
  task->SetWorkItem(work);
  return task;
}

TEST(ThreadPoolTest, RunsInOrderOnOneThread) {
  std::vector<int> order;
  {
    ThreadPool pool(1);
    for (int i = 0; i != 100; ++i) {
      pool.Schedule(TaskWith([&order, i]() { order.push_back(i); }));
    }
  }
  ASSERT_EQ(order.size(), 100);
  for (int i = 0; i != 100; ++i) EXPECT_EQ(order[i], i);
}

TEST(ThreadPoolTest, DependenciesComeFirst) {
  std::vector<int> order;
  {
    ThreadPool pool(1);
    absl::Mutex hold;
    hold.Lock();
    const auto first = pool.Schedule(TaskWith([&]() {
      absl::MutexLock lock(&hold);
      order.push_back(0);
    }));
    auto dependent = TaskWith([&order]() { order.push_back(2); });
    dependent->AddDependency(first);
    pool.Schedule(std::move(dependent));
    pool.Schedule(TaskWith([&order]() { order.push_back(1); }));
    // Nothing has run inline.
    EXPECT_TRUE(order.empty());
    hold.Unlock();
  }
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
}

TEST(ThreadPoolTest, WorkMayScheduleWork) {
  ThreadPool pool(1);
  absl::BlockingCounter done(1);
  pool.Schedule(TaskWith(
      [&]() { pool.Schedule(TaskWith([&]() { done.DecrementCount(); })); }));
  done.Wait();
}

TEST(ThreadPoolTest, MaySchedulerHoldALockThatWorkTakes) {
  absl::Mutex mutex;
  int runs = 0;
  ThreadPool pool(2);
  absl::BlockingCounter done(10);
  {
    absl::MutexLock lock(&mutex);
    for (int i = 0; i != 10; ++i) {
      pool.Schedule(TaskWith([&]() {
        {
          absl::MutexLock inner(&mutex);
          ++runs;
        }
        done.DecrementCount();
      }));
    }
  }
  done.Wait();
  absl::MutexLock lock(&mutex);
  EXPECT_EQ(runs, 10);
}

// Many tasks with random dependencies from several threads: each runs exactly
// once and after all it depends on.
void Stress(const int num_threads) {
  constexpr int kNumSchedulers = 3;
  constexpr int kTasksEach = 2000;
  struct Entry {
    std::atomic<bool> done{false};
    std::weak_ptr<Task> task;
  };
  std::vector<std::vector<Entry>> entries;
  for (int i = 0; i != kNumSchedulers; ++i) {
    entries.emplace_back(std::vector<Entry>(kTasksEach));
  }
  std::atomic<int> runs{0};
  std::atomic<int> too_early{0};
  {
    ThreadPool pool(num_threads);
    std::vector<std::thread> schedulers;
    for (int s = 0; s != kNumSchedulers; ++s) {
      schedulers.emplace_back([&, s]() {
        std::minstd_rand engine(s + 1);
        std::vector<Entry>& mine = entries[s];
        for (int i = 0; i != kTasksEach; ++i) {
          std::vector<int> needs;
          for (int k = engine() % 4; k > 0 && i > 0; --k) {
            const int need = engine() % i;
            bool is_new = true;
            for (const int other : needs) is_new = is_new && other != need;
            if (is_new) needs.push_back(need);
          }
          auto task = TaskWith([&, i, needs]() {
            for (const int need : needs) {
              if (!mine[need].done) ++too_early;
            }
            mine[i].done = true;
            ++runs;
          });
          for (const int need : needs) task->AddDependency(mine[need].task);
          mine[i].task = pool.Schedule(std::move(task));
        }
      });
    }
    for (std::thread& scheduler : schedulers) scheduler.join();
    // Waiting tasks are released by ready ones, so wait before the end.
    while (runs < kNumSchedulers * kTasksEach) std::this_thread::yield();
  }
  EXPECT_EQ(runs, kNumSchedulers * kTasksEach);
  EXPECT_EQ(too_early, 0);
}

TEST(ThreadPoolTest, StressOneThread) { Stress(1); }
TEST(ThreadPoolTest, StressFourThreads) { Stress(4); }

TEST(ThreadPoolTest, DestructorRunsWhatBecomesReady) {
  std::atomic<int> runs{0};
  {
    ThreadPool pool(2);
    std::weak_ptr<Task> previous;
    for (int i = 0; i != 200; ++i) {
      auto task = TaskWith([&runs]() { ++runs; });
      task->AddDependency(previous);
      previous = pool.Schedule(std::move(task));
    }
  }
  // A chain: the one thread that completes a link takes up the next.
  EXPECT_EQ(runs, 200);
}

TEST(ThreadPoolForTestingTest, WaitUntilIdle) {
  testing::ThreadPoolForTesting pool;
  pool.WaitUntilIdle();
  std::atomic<int> runs{0};
  for (int round = 1; round <= 3; ++round) {
    const auto first = pool.Schedule(TaskWith([&runs]() { ++runs; }));
    auto second = TaskWith([&runs]() { ++runs; });
    second->AddDependency(first);
    pool.Schedule(std::move(second));
    pool.WaitUntilIdle();
    EXPECT_EQ(runs, 2 * round);
  }
}

TEST(ThreadPoolDeathTest, NeedsThreads) {
  EXPECT_DEATH(ThreadPool(0), "without threads");
}

}  // namespace
}  // namespace common
}  // namespace cartographer
