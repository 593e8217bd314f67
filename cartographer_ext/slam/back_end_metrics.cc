// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/back_end_metrics.h"

#include <thread>

namespace cartographer_ext {
namespace evaluation {
namespace {

constexpr char kConstraintsMetric[] =
    "mapping_constraints_constraint_builder_2d_constraints";
constexpr char kOurSearchesMetric[] = "cartographer_ext_loop_searches";

}  // namespace

double CountPairs(const MetricsCollector& metrics, const std::string& matcher) {
  return metrics.Sum(kConstraintsMetric, {{"matcher", matcher}}) +
         metrics.Sum(kOurSearchesMetric, {{"matcher", matcher}});
}

LoopCpu MeasureLoopCpu(const MetricsCollector& metrics) {
  const auto stage = [&metrics](const char* const name) {
    return metrics.Sum(kSearchCpuMetric, {{"stage", name}}) +
           metrics.Sum(kOurCpuMetric, {{"stage", name}});
  };
  LoopCpu cpu;
  // Stock's time of the search includes the refinement.
  cpu.search = stage("search") + stage("refinement");
  cpu.build = stage("build");
  cpu.verification = stage("verification") + stage("planning");
  return cpu;
}

LoopCpu operator-(const LoopCpu& after, const LoopCpu& before) {
  LoopCpu difference;
  difference.search = after.search - before.search;
  difference.build = after.build - before.build;
  difference.verification = after.verification - before.verification;
  return difference;
}

void WaitForBackEnd(const MetricsCollector& metrics, const int max_length,
                    const std::chrono::seconds patience) {
  constexpr auto kPause = std::chrono::milliseconds(2);
  double length = metrics.Sum(kQueueMetric);
  auto last_change = std::chrono::steady_clock::now();
  while (length > max_length) {
    std::this_thread::sleep_for(kPause);
    const double now = metrics.Sum(kQueueMetric);
    if (now != length) {
      length = now;
      last_change = std::chrono::steady_clock::now();
    } else if (std::chrono::steady_clock::now() - last_change > patience) {
      return;
    }
  }
}

}  // namespace evaluation
}  // namespace cartographer_ext
