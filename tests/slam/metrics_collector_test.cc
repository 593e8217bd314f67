// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/metrics_collector.h"

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "gmock/gmock.h"
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

// What the rules for Prometheus select is what the modules register: every
// family, and every label with one of its values.
TEST(MetricsCollectorTest, ThePrometheusRulesSelectWhatThereIs) {
  std::set<std::string> families, labels;
  for (const auto& entry : MetricsCollector::Global()->Values()) {
    const std::vector<std::string> parts =
        absl::StrSplit(entry.first, absl::ByAnyChar("{,}"));
    families.insert(parts[0]);
    for (size_t i = 1; i < parts.size(); ++i) {
      labels.insert(absl::StrCat(parts[0], " ", parts[i]));
    }
  }
  std::ifstream stream("examples/prometheus/rules.yaml");
  const std::string rules{std::istreambuf_iterator<char>(stream), {}};
  const std::regex selector(
      R"re(((?:cartographer_ext|mapping_2d)_[a-z0-9_]+)(?:\{(\w+)=~?"([^"]*)"\})?)re");
  int num_labels = 0;
  std::set<std::string> selected;
  for (std::sregex_iterator it(rules.begin(), rules.end(), selector), end;
       it != end; ++it) {
    const std::string family =
        std::regex_replace((*it)[1].str(), std::regex("_bucket$"), "");
    selected.insert(family);
    EXPECT_THAT(families, testing::Contains(family));
    if (!(*it)[2].matched) continue;
    const std::vector<std::string> values = absl::StrSplit((*it)[3].str(), '|');
    for (const std::string& value : values) {
      ++num_labels;
      EXPECT_THAT(labels, testing::Contains(absl::StrCat(
                              family, " ", (*it)[2].str(), "=", value)));
    }
  }
  EXPECT_EQ(selected.size(), 5u);
  EXPECT_EQ(num_labels, 7);
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
