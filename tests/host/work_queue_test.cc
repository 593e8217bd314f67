// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer/mapping/internal/work_queue.h"

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/common/task.h"
#include "gtest/gtest.h"

namespace cartographer {
namespace mapping {
namespace {

using Result = WorkItem::Result;

// A queue whose barriers end some time later, on any thread of the pool.
class QueueWithBarriers {
 public:
  explicit QueueWithBarriers(const int num_threads)
      : pool_(num_threads), queue_(&pool_, [this](const Result result) {
          barriers_.push_back(result);
          auto task = absl::make_unique<common::Task>();
          task->SetWorkItem([this]() { queue_.Resume(); });
          pool_.Schedule(std::move(task));
        }) {}
  ~QueueWithBarriers() { queue_.WaitUntilIdle(); }

  WorkQueue& queue() { return queue_; }
  // Only the active item and barrier touch it.
  const std::vector<Result>& barriers() const { return barriers_; }

 private:
  common::ThreadPool pool_;
  std::vector<Result> barriers_;
  WorkQueue queue_;
};

TEST(WorkQueueTest, IdleFromTheStart) {
  QueueWithBarriers queue(1);
  queue.queue().WaitUntilIdle();

  EXPECT_EQ(queue.queue().DelaySeconds(), 0.);
}

TEST(WorkQueueTest, ItemsAndBarriersKeepTheirOrder) {
  for (const int num_threads : {1, 3}) {
    QueueWithBarriers queue(num_threads);
    std::vector<int> order;
    for (int i = 0; i < 200; ++i) {
      queue.queue().Add([&order, &queue, i]() {
        EXPECT_EQ(queue.barriers().size(), (i + 6) / 7);
        order.push_back(i);
        return i % 7 == 0  ? Result::kRunOptimization
               : i == 1000 ? Result::kCollectConstraints
                           : Result::kDoNotRunOptimization;
      });
    }
    queue.queue().WaitUntilIdle();
    ASSERT_EQ(order.size(), 200);
    for (int i = 0; i < 200; ++i) EXPECT_EQ(order[i], i);
    EXPECT_EQ(queue.barriers().size(), 29);
  }
}

TEST(WorkQueueTest, ItemsMayAddItems) {
  QueueWithBarriers queue(2);
  int num_run = 0;
  queue.queue().Add([&]() {
    queue.queue().Add([&num_run]() {
      ++num_run;
      return Result::kCollectConstraints;
    });
    ++num_run;
    return Result::kDoNotRunOptimization;
  });
  queue.queue().WaitUntilIdle();
  EXPECT_EQ(num_run, 2);
  EXPECT_EQ(queue.barriers(),
            (std::vector<Result>{Result::kCollectConstraints}));
}

// Many producers, waiters and barriers; run under a thread sanitizer.
TEST(WorkQueueTest, Stress) {
  QueueWithBarriers queue(4);
  constexpr int kNumProducers = 4;
  constexpr int kNumItems = 500;
  std::atomic<int> num_inside{0};
  int num_run = 0;  // guarded by the queue running one item at a time
  std::vector<int> last_of_producer(kNumProducers, -1);
  std::vector<std::thread> producers;
  for (int p = 0; p < kNumProducers; ++p) {
    producers.emplace_back([&, p]() {
      for (int i = 0; i < kNumItems; ++i) {
        queue.queue().Add([&, p, i]() {
          EXPECT_EQ(num_inside.fetch_add(1), 0);
          EXPECT_EQ(last_of_producer[p], i - 1);
          last_of_producer[p] = i;
          ++num_run;
          num_inside.fetch_sub(1);
          return i % 50 == 0 ? Result::kRunOptimization
                             : Result::kDoNotRunOptimization;
        });
        if (i % 100 == 0) queue.queue().WaitUntilIdle();
      }
    });
  }
  for (std::thread& producer : producers) producer.join();
  queue.queue().WaitUntilIdle();
  EXPECT_EQ(num_run, kNumProducers * kNumItems);
  EXPECT_EQ(queue.barriers().size(), kNumProducers * kNumItems / 50);
}

// As the wait for a short queue relies on it.
TEST(WorkQueueTest, TellsEveryChangeOfItsSize) {
  std::vector<size_t> sizes;
  {
    common::ThreadPool pool(2);
    WorkQueue queue(
        &pool, [](Result) { FAIL() << "no barrier is expected"; },
        [&sizes](const size_t size) { sizes.push_back(size); });
    for (int i = 0; i < 100; ++i) {
      queue.Add([]() { return Result::kDoNotRunOptimization; });
    }
    queue.WaitUntilIdle();
  }
  ASSERT_EQ(sizes.size(), 200);
  size_t last = 0;
  for (const size_t size : sizes) {
    EXPECT_TRUE(size == last + 1 || size + 1 == last);
    last = size;
  }
  EXPECT_EQ(last, 0);
}

}  // namespace
}  // namespace mapping
}  // namespace cartographer
