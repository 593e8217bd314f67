// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/back_end_metrics.h"

#include <chrono>
#include <thread>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

using Clock = std::chrono::steady_clock;

TEST(BackEndMetricsTest, CountsThePairsOfEitherBuilder) {
  MetricsCollector metrics;
  EXPECT_EQ(CountPairs(metrics, "searched"), 0.);
  auto* const stock = metrics.NewCounterFamily(
      "mapping_constraints_constraint_builder_2d_constraints", "");
  stock->Add({{"search_region", "local"}, {"matcher", "searched"}})
      ->Increment(5.);
  stock->Add({{"search_region", "global"}, {"matcher", "searched"}})
      ->Increment(2.);
  stock->Add({{"search_region", "local"}, {"matcher", "found"}})->Increment(1.);
  auto* const ours =
      metrics.NewCounterFamily("cartographer_ext_loop_searches", "");
  ours->Add({{"search_region", "local"}, {"matcher", "searched"}})
      ->Increment(30.);
  EXPECT_EQ(CountPairs(metrics, "searched"), 37.);
  EXPECT_EQ(CountPairs(metrics, "found"), 1.);
  EXPECT_EQ(CountPairs(metrics, "lost"), 0.);
}

TEST(BackEndMetricsTest, AShortQueueIsNotWaitedFor) {
  MetricsCollector metrics;
  // Also where the metric is not there at all.
  WaitForBackEnd(metrics, 0, std::chrono::seconds(100));
  auto* const queue = metrics.NewGaugeFamily(kQueueMetric, "")->Add({});
  queue->Set(7.);
  const auto start = Clock::now();
  WaitForBackEnd(metrics, 7, std::chrono::seconds(100));
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(50));
}

TEST(BackEndMetricsTest, WaitsUntilTheQueueIsShort) {
  MetricsCollector metrics;
  auto* const queue = metrics.NewGaugeFamily(kQueueMetric, "")->Add({});
  queue->Set(50.);
  std::thread worker([queue]() {
    for (int length = 49; length >= 0; --length) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      queue->Set(length);
    }
  });
  WaitForBackEnd(metrics, 10, std::chrono::seconds(100));
  EXPECT_LE(metrics.Sum(kQueueMetric), 10.);
  worker.join();
}

TEST(BackEndMetricsTest, GivesUpWhenNothingMoves) {
  MetricsCollector metrics;
  metrics.NewGaugeFamily(kQueueMetric, "")->Add({})->Set(50.);
  const auto start = Clock::now();
  WaitForBackEnd(metrics, 10, std::chrono::seconds(0));
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(50));
  EXPECT_EQ(metrics.Sum(kQueueMetric), 50.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
