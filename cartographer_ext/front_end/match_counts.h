// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#ifndef CARTOGRAPHER_EXT_FRONT_END_MATCH_COUNTS_H_
#define CARTOGRAPHER_EXT_FRONT_END_MATCH_COUNTS_H_

#include <cstdint>
#include <string>

#include "cartographer_ext/match_record.pb.h"

namespace cartographer_ext {
namespace front_end {

// Whether odometry was found at fault: stale, jumping, wrong sign, slipping.
bool IsOdometryFault(const proto::MatchRecord& record);

// What local SLAM met with.
struct MatchCounts {
  int64_t scans = 0;
  int64_t degenerate = 0;
  int64_t searched = 0;
  int64_t relocated = 0;
  int64_t odometry_faults = 0;  // stale, jumping, wrong sign, slipping
  int64_t slip_suspected = 0;
  // Of the last scan: seconds, and the calibration of odometry.
  double time_offset = 0.;
  double odometry_scale = 0.;
  double odometry_scale_sigma = 0.;
  double rotation_scale = 0.;
  double rotation_per_metre = 0.;  // radians
  // Of the last scan, too.
  proto::MatchRecord::Gyroscope gyroscope = proto::MatchRecord::NO_GYROSCOPE;
  double gyroscope_factor = 0.;
  double gyroscope_factor_sigma = 0.;

  void Add(const proto::MatchRecord& record);
};

// "7374 scans, 12.3 % of them degenerate, 5 searches, 3 odometry faults;
// odometry scale 1.003 +- 0.002, scans stamped 0.030 s later than odometry".
std::string ToText(const MatchCounts& counts);

// Why the gyroscope was not used, if it contradicts the scans; otherwise empty.
std::string WarningOfGyroscope(const MatchCounts& counts);

}  // namespace front_end
}  // namespace cartographer_ext

#endif  // CARTOGRAPHER_EXT_FRONT_END_MATCH_COUNTS_H_
