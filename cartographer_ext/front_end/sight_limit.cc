// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/sight_limit.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace cartographer_ext {
namespace front_end {
namespace {

// The walls of a submap end where the sight of the scans before did, which are
// inserted every 0.2 m, and it takes six hits until a cell is believed as much as
// ever; metres.
constexpr double kLimitZone = 1.;
// Ranges at the limit differ by less, metres.
constexpr double kSpread = 0.5;
// Longer ranges of a scan, of which there are at least this many, are no
// outliers.
constexpr size_t kMinFarthest = 3;
// This many scans, this far from each other, distinguish the limit of a laser
// from the size of a room.
constexpr int kMinScansAtLimit = 50;
constexpr double kRangeStep = 0.2;  // metres

}  // namespace

void SightLimit::Add(const Pose2& pose, std::vector<float> ranges) {
  if (ranges.size() < kMinFarthest) return;
  if (scans_ > 0 &&
      (pose.translation() - pose_.translation()).norm() < kRangeStep) {
    return;
  }
  pose_ = pose;
  std::nth_element(ranges.begin(), ranges.begin() + (kMinFarthest - 1),
                   ranges.end(), std::greater<float>());
  const double range = ranges[kMinFarthest - 1];
  if (range > range_ + kSpread) scans_ = scans_at_limit_ = 0;
  range_ = std::max(range_, range);
  ++scans_;
  scans_at_limit_ += range > range_ - kSpread ? 1 : 0;
}

double SightLimit::Limit() const {
  // Otherwise the size of the building limits the range.
  const bool is_limit =
      scans_ >= kMinScansAtLimit && 2 * scans_at_limit_ >= scans_;
  return is_limit ? std::max(0., range_ - kLimitZone)
                  : std::numeric_limits<double>::infinity();
}

}  // namespace front_end
}  // namespace cartographer_ext
