// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/tools/slam_progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"

namespace cartographer_ext {
namespace tools {
namespace {

constexpr double kGrowth = 1.5;  // of the time with the scans
constexpr double kNodesAScan = 0.6;
// Of the time of the mapping.
constexpr double kShareOfLastOptimization = 0.2;
constexpr double kShareOfJudging = 0.45;
constexpr int64_t kLongQueue = 10;

double Now() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

double EstimateSecondsLeft(const SlamWork& work, const double elapsed_seconds) {
  if (work.scans <= 0 || work.total_scans <= 0) return 0.;
  const double waiting = static_cast<double>(work.queue_length) /
                         (kNodesAScan + work.readings_a_scan);
  // The queue may hold more readings than estimated from the number of scans.
  const double done =
      std::max(static_cast<double>(work.scans) - waiting, 0.1 * work.scans);
  const double mapping =
      elapsed_seconds *
      std::pow(std::max(1., work.total_scans / done), kGrowth);
  const double after =
      kShareOfLastOptimization + (work.judges_map ? kShareOfJudging : 0.);
  return mapping - elapsed_seconds + after * mapping;
}

SlamProgressLine::SlamProgressLine(const SlamWork& work)
    : work_(work),
      start_(Now()),
      line_(std::make_unique<Progress>("mapping", work.total_scans)) {}

void SlamProgressLine::Update(const int64_t scans, const int64_t queue_length,
                              const bool last) {
  work_.scans = scans;
  work_.queue_length = queue_length;
  const double left = EstimateSecondsLeft(work_, Now() - start_);
  if (last) {
    line_ = std::make_unique<Progress>("closing loops, last optimisation", 0);
    line_->Update(0, "", left);
    return;
  }
  line_->Update(
      scans,
      queue_length > kLongQueue ? absl::StrCat("queue ", queue_length) : "",
      left);
}

std::unique_ptr<Progress> ShowStep(const char* const name) {
  auto step = std::make_unique<Progress>(name, 0);
  step->Update(0);
  return step;
}

}  // namespace tools
}  // namespace cartographer_ext
