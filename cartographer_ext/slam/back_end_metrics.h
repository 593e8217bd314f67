// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// What the metrics report of the back end, whichever constraint builder it has.
#ifndef CARTOGRAPHER_EXT_SLAM_BACK_END_METRICS_H_
#define CARTOGRAPHER_EXT_SLAM_BACK_END_METRICS_H_

#include <chrono>
#include <string>

#include "cartographer_ext/slam/metrics_collector.h"

namespace cartographer_ext {
namespace evaluation {

constexpr char kQueueMetric[] = "mapping_2d_pose_graph_work_queue_size";
// CPU seconds of stock's loop search, by stage; a real library has none.
constexpr char kSearchCpuMetric[] =
    "mapping_constraints_constraint_builder_2d_search_cpu_seconds";
// CPU seconds of our constraint builder, by stage.
constexpr char kOurCpuMetric[] = "cartographer_ext_loop_cpu_seconds";

// Pairs of submap and node that either builder has "searched" or "found".
double CountPairs(const MetricsCollector& metrics, const std::string& matcher);

// CPU seconds that closing loops has taken so far, of either builder, the
// optimisation aside. Zero for a real library, which does not report it.
struct LoopCpu {
  // Correlative search and the refinement of what it finds.
  double search = 0.;
  double build = 0.;  // preparing submaps to be searched
  // Planning of searches and verification of matches; ours only.
  double verification = 0.;

  double total() const { return search + build + verification; }
};

LoopCpu MeasureLoopCpu(const MetricsCollector& metrics);
LoopCpu operator-(const LoopCpu& after, const LoopCpu& before);

// Waits until the queue of the pose graph is short again, which bounds memory
// and changes no result. Gives up when nothing moves for `patience`: then the
// number is not what it is taken for.
void WaitForBackEnd(const MetricsCollector& metrics, int max_length,
                    std::chrono::seconds patience);

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_BACK_END_METRICS_H_
