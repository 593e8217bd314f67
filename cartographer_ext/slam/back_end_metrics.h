// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Metrics of the back end, for both constraint builders.
#ifndef CARTOGRAPHER_EXT_SLAM_BACK_END_METRICS_H_
#define CARTOGRAPHER_EXT_SLAM_BACK_END_METRICS_H_

#include <chrono>
#include <string>

#include "cartographer_ext/slam/metrics_collector.h"

namespace cartographer_ext {
namespace evaluation {

constexpr char kQueueMetric[] = "mapping_2d_pose_graph_work_queue_size";
// CPU seconds of stock's loop search, by stage; not available in the real
// library.
constexpr char kSearchCpuMetric[] =
    "mapping_constraints_constraint_builder_2d_search_cpu_seconds";
// CPU seconds of our constraint builder, by stage.
constexpr char kOurCpuMetric[] = "cartographer_ext_loop_cpu_seconds";

// Number of pairs of submap and node that either builder has "searched" or
// "found".
double CountPairs(const MetricsCollector& metrics, const std::string& matcher);

// CPU seconds of loop closure so far, of either builder, without the
// optimisation. Zero for the real library, which does not report it.
struct LoopCpu {
  // Correlative search and refinement of the matches.
  double search = 0.;
  double build = 0.;  // preparing submaps to be searched
  // Planning of searches and verification of matches; ours only.
  double verification = 0.;

  double total() const { return search + build + verification; }
};

LoopCpu MeasureLoopCpu(const MetricsCollector& metrics);
LoopCpu operator-(const LoopCpu& after, const LoopCpu& before);

// Waits until the queue of the pose graph is short again, which bounds memory
// without affecting the result. Gives up if the queue does not change for
// `patience`, in case the metric is not the expected one.
void WaitForBackEnd(const MetricsCollector& metrics, int max_length,
                    std::chrono::seconds patience);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_BACK_END_METRICS_H_
