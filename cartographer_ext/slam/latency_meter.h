// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// How long a robot would wait: the time that local SLAM takes for a scan, and
// how far the back end is behind.
//
// The host may handle a scan only when the next reading of another sensor has
// come, so that all readings since the scan before count for a scan. The back
// end is behind by the age of the oldest node that waits in its queue.
//
// Not thread-safe.
#ifndef CARTOGRAPHER_EXT_SLAM_LATENCY_METER_H_
#define CARTOGRAPHER_EXT_SLAM_LATENCY_METER_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace cartographer_ext {
namespace evaluation {

struct LatencySummary {
  int64_t scans = 0;
  // Wall time of local SLAM for a scan, milliseconds; 0 without scans. The
  // percentiles are those of the nearest rank.
  double local_slam_p50 = 0.;
  double local_slam_p99 = 0.;
  double local_slam_max = 0.;
  double max_backlog = 0.;  // seconds of wall time
};

class LatencyMeter {
 public:
  // A reading was handled within `seconds` of wall time.
  void AddReading(double seconds, bool is_scan);
  // A node was handed to the back end at `now`, in seconds of any clock.
  void AddNode(double now);
  // So many nodes wait in the back end at `now`, later than those before.
  void SetQueueLength(size_t num_nodes, double now);

  LatencySummary Summary() const;

 private:
  double since_scan_ = 0.;
  std::vector<double> scans_;  // milliseconds
  std::deque<double> nodes_;   // that may wait, when they were handed over
  double max_backlog_ = 0.;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_LATENCY_METER_H_
