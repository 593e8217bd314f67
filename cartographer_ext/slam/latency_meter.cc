// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/latency_meter.h"

#include <algorithm>

#include "cartographer_ext/common/order_statistics.h"

namespace cartographer_ext {
namespace evaluation {

void LatencyMeter::AddReading(const double seconds, const bool is_scan) {
  since_scan_ += seconds;
  if (!is_scan) return;
  scans_.push_back(1e3 * since_scan_);
  since_scan_ = 0.;
}

void LatencyMeter::AddNode(const double now) { nodes_.push_back(now); }

void LatencyMeter::SetQueueLength(const size_t num_nodes, const double now) {
  while (nodes_.size() > num_nodes) nodes_.pop_front();
  if (nodes_.empty()) return;
  max_backlog_ = std::max(max_backlog_, now - nodes_.front());
}

LatencySummary LatencyMeter::Summary() const {
  LatencySummary summary;
  summary.scans = static_cast<int64_t>(scans_.size());
  summary.max_backlog = max_backlog_;
  if (scans_.empty()) return summary;
  summary.local_slam_p50 = NearestRankQuantile(scans_, 0.5);
  summary.local_slam_p99 = NearestRankQuantile(scans_, 0.99);
  summary.local_slam_max = NearestRankQuantile(scans_, 1.);
  return summary;
}

}  // namespace evaluation
}  // namespace cartographer_ext
