// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Latency on a robot: the time of local SLAM per scan, and the delay of the
// back end.
//
// The host may process a scan only when the next reading of another sensor
// arrives, so the time of all readings since the previous scan is attributed to
// a scan. The delay of the back end is the age of the oldest node in its queue.
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
  // Wall time of local SLAM for a scan, milliseconds; 0 without scans.
  // Percentiles by nearest rank.
  double local_slam_p50 = 0.;
  double local_slam_p99 = 0.;
  double local_slam_max = 0.;
  double max_backlog = 0.;  // seconds of wall time
};

class LatencyMeter {
 public:
  // Adds a reading that was processed within `seconds` of wall time.
  void AddReading(double seconds, bool is_scan);
  // Adds a node that was passed to the back end at `now`, in seconds of any
  // clock.
  void AddNode(double now);
  // Sets the number of nodes in the queue at `now`, later than in previous
  // calls.
  void SetQueueLength(size_t num_nodes, double now);

  LatencySummary Summary() const;

 private:
  double since_scan_ = 0.;
  std::vector<double> scans_;  // milliseconds
  std::deque<double> nodes_;   // times of queued nodes
  double max_backlog_ = 0.;
};

}  // namespace evaluation
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_SLAM_LATENCY_METER_H_
