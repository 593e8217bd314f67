// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/slam/latency_meter.h"

#include <algorithm>
#include <cmath>

namespace cartographer_ext {
namespace evaluation {
namespace {

// Of sorted values: the smallest that a share of them does not exceed.
double NearestRank(const std::vector<float>& sorted, const double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<size_t>(std::max(1., rank)) - 1];
}

}  // namespace

void LatencyMeter::AddReading(const double seconds, const bool is_scan) {
  since_scan_ += seconds;
  if (!is_scan) return;
  scans_.push_back(static_cast<float>(1e3 * since_scan_));
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
  std::vector<float> sorted = scans_;
  std::sort(sorted.begin(), sorted.end());
  summary.local_slam_p50 = NearestRank(sorted, 0.5);
  summary.local_slam_p99 = NearestRank(sorted, 0.99);
  summary.local_slam_max = sorted.back();
  return summary;
}

}  // namespace evaluation
}  // namespace cartographer_ext
