// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates the remaining time of a run. Scans are fed faster than the back end
// processes them, and their cost grows with the map, so the share of fed scans
// is a poor measure. Instead, scans processed by the back end are counted;
// their number grows with time as n ~ t^(2/3), and the steps after mapping take
// a fixed fraction of the mapping time. Exponent and fraction are those of
// ACES.
#ifndef CARTOGRAPHER_EXT_TOOLS_SLAM_PROGRESS_H_
#define CARTOGRAPHER_EXT_TOOLS_SLAM_PROGRESS_H_

#include <cstdint>
#include <memory>

#include "cartographer_ext/common/progress.h"

namespace cartographer_ext {
namespace tools {

struct SlamWork {
  int64_t scans = 0;  // fed
  int64_t total_scans = 0;
  int64_t queue_length = 0;     // of the back end
  double readings_a_scan = 0.;  // odometry and IMU that are queued, too
  bool judges_map = false;      // for the report, at the end
};

// Remaining seconds of the whole run. 0 without scans.
double EstimateSecondsLeft(const SlamWork& work, double elapsed_seconds);

// The progress line of the steps up to the last optimisation.
class SlamProgressLine {
 public:
  explicit SlamProgressLine(const SlamWork& work);
  // `last` is the last optimisation, which reports no progress until it is
  // done.
  void Update(int64_t scans, int64_t queue_length, bool last);

 private:
  SlamWork work_;
  const double start_;
  std::unique_ptr<Progress> line_;
};

// Shows a step without counts, until the next one or the end.
std::unique_ptr<Progress> ShowStep(const char* name);

}  // namespace tools
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_TOOLS_SLAM_PROGRESS_H_
