// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The metrics that the parts of PoseGraph2D share.
#ifndef CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_METRICS_H_
#define CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_METRICS_H_

#include "cartographer/metrics/gauge.h"

namespace cartographer {
namespace mapping {

struct PoseGraph2DMetrics {
  metrics::Gauge* work_queue_delay = metrics::Gauge::Null();
  metrics::Gauge* work_queue_size = metrics::Gauge::Null();
  metrics::Gauge* constraints_same_trajectory = metrics::Gauge::Null();
  metrics::Gauge* constraints_different_trajectory = metrics::Gauge::Null();
  metrics::Gauge* active_submaps = metrics::Gauge::Null();
  metrics::Gauge* frozen_submaps = metrics::Gauge::Null();
  metrics::Gauge* deleted_submaps = metrics::Gauge::Null();
};

// One for the process, as the metrics of all classes are.
PoseGraph2DMetrics& GetPoseGraph2DMetrics();

}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_MAPPING_INTERNAL_2D_POSE_GRAPH_2D_METRICS_H_
