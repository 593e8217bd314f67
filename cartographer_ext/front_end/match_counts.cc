// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/match_counts.h"

#include <algorithm>

#include "absl/strings/str_format.h"

namespace cartographer_ext {
namespace front_end {

using proto::MatchRecord;

bool IsOdometryFault(const MatchRecord& record) {
  return record.odometry() == MatchRecord::STALE ||
         record.odometry() == MatchRecord::JUMPING ||
         record.odometry() == MatchRecord::WRONG_SIGN ||
         record.odometry() == MatchRecord::SLIPPING;
}

void MatchCounts::Add(const MatchRecord& record) {
  ++scans;
  if (record.degeneracy() != MatchRecord::NONE) ++degenerate;
  if (record.searched()) ++searched;
  if (record.source() == MatchRecord::SEARCH) ++relocated;
  if (IsOdometryFault(record)) ++odometry_faults;
  if (record.odometry() == MatchRecord::SLIP_SUSPECTED) ++slip_suspected;
  time_offset = record.time_offset();
  odometry_scale = record.odometry_scale();
  odometry_scale_sigma = record.odometry_scale_sigma();
  rotation_scale = record.rotation_scale();
  rotation_per_metre = record.rotation_per_metre();
  gyroscope = record.gyroscope();
  gyroscope_factor = record.gyroscope_factor();
  gyroscope_factor_sigma = record.gyroscope_factor_sigma();
}

std::string ToText(const MatchCounts& counts) {
  return absl::StrFormat(
      "%d scans, %.1f %% of them degenerate, %d searches, %d odometry faults; "
      "odometry scale %.4f +- %.4f, scans stamped %.3f s later than odometry",
      counts.scans,
      100. * static_cast<double>(counts.degenerate) /
          static_cast<double>(std::max<int64_t>(1, counts.scans)),
      counts.searched, counts.odometry_faults, counts.odometry_scale,
      counts.odometry_scale_sigma, counts.time_offset);
}

std::string WarningOfGyroscope(const MatchCounts& counts) {
  if (counts.gyroscope != MatchRecord::REFUTED) return "";
  return absl::StrFormat(
      "the gyroscope of the IMU contradicts the scans, which turn by %.2f +- "
      "%.2f of what it measures: it is not used; check its mount, sign, unit "
      "and stamps",
      counts.gyroscope_factor, counts.gyroscope_factor_sigma);
}

}  // namespace front_end
}  // namespace cartographer_ext
