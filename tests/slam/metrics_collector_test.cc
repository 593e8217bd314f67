// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/metrics_collector.h"

#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace evaluation {
namespace {

TEST(MetricsCollectorTest, SumsByLabels) {
  MetricsCollector collector;
  auto* const family = collector.NewCounterFamily("searches", "unused");
  auto* const local =
      family->Add({{"region", "local"}, {"matcher", "searched"}});
  auto* const global =
      family->Add({{"region", "global"}, {"matcher", "searched"}});
  auto* const found = family->Add({{"region", "local"}, {"matcher", "found"}});
  local->Increment();
  local->Increment(2.);
  global->Increment(10.);
  found->Increment(100.);
  EXPECT_EQ(collector.Sum("searches"), 113.);
  EXPECT_EQ(collector.Sum("searches", {{"matcher", "searched"}}), 13.);
  EXPECT_EQ(collector.Sum("searches", {{"region", "global"}}), 10.);
  EXPECT_EQ(collector.Sum("searches", {{"colour", "red"}}), 0.);
  EXPECT_EQ(collector.Sum("others"), 0.);
  EXPECT_TRUE(collector.Has("searches"));
  EXPECT_FALSE(collector.Has("others"));
  const auto values = collector.Values();
  EXPECT_EQ(values.at("searches{matcher=searched,region=local}"), 3.);
}

TEST(MetricsCollectorTest, GaugesGoUpAndDown) {
  MetricsCollector collector;
  auto* const gauge = collector.NewGaugeFamily("queue", "unused")->Add({});
  gauge->Set(5.);
  gauge->Increment();
  gauge->Decrement(3.);
  EXPECT_EQ(collector.Sum("queue"), 3.);
}

TEST(MetricsCollectorTest, HistogramsCountObservations) {
  MetricsCollector collector;
  auto* const histogram =
      collector.NewHistogramFamily("scores", "unused", {0.5, 1.})->Add({});
  histogram->Observe(0.3);
  histogram->Observe(0.7);
  EXPECT_EQ(collector.Sum("scores"), 2.);
}

TEST(MetricsCollectorTest, ThreadsLoseNothing) {
  MetricsCollector collector;
  auto* const counter = collector.NewCounterFamily("count", "unused")->Add({});
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([counter] {
      for (int j = 0; j < 10000; ++j) counter->Increment();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(collector.Sum("count"), 40000.);
}

}  // namespace
}  // namespace evaluation
}  // namespace cartographer_ext
