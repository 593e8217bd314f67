// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/match_counts.h"

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using proto::MatchRecord;

MatchRecord WithOdometry(const MatchRecord::OdometryState state) {
  MatchRecord record;
  record.set_odometry(state);
  return record;
}

TEST(MatchCountsTest, AbsentAndSuspectedAreNoFaults) {
  for (const auto state : {MatchRecord::STALE, MatchRecord::JUMPING,
                           MatchRecord::WRONG_SIGN, MatchRecord::SLIPPING}) {
    EXPECT_TRUE(IsOdometryFault(WithOdometry(state))) << state;
  }
  for (const auto state :
       {MatchRecord::OK, MatchRecord::ABSENT, MatchRecord::SLIP_SUSPECTED}) {
    EXPECT_FALSE(IsOdometryFault(WithOdometry(state))) << state;
  }
}

TEST(MatchCountsTest, CountsScansAndKeepsTheLastCalibration) {
  MatchCounts counts;
  counts.Add(WithOdometry(MatchRecord::STALE));
  counts.Add(WithOdometry(MatchRecord::SLIP_SUSPECTED));
  MatchRecord record;
  record.set_degeneracy(MatchRecord::TRANSLATION);
  record.set_searched(true);
  record.set_source(MatchRecord::SEARCH);
  record.set_odometry_scale(1.25);
  record.set_odometry_scale_sigma(0.5);
  record.set_time_offset(0.03);
  counts.Add(record);
  record.set_source(MatchRecord::ODOMETRY);  // the search changed nothing
  record.set_odometry_scale(1.003);
  record.set_odometry_scale_sigma(0.002);
  counts.Add(record);
  EXPECT_EQ(counts.scans, 4);
  EXPECT_EQ(counts.odometry_faults, 1);
  EXPECT_EQ(counts.slip_suspected, 1);
  EXPECT_EQ(counts.degenerate, 2);
  EXPECT_EQ(counts.searched, 2);
  EXPECT_EQ(counts.relocated, 1);
  EXPECT_EQ(ToText(counts),
            "4 scans, 50.0 % of them degenerate, 2 searches, 1 odometry "
            "faults; odometry scale 1.0030 +- 0.0020, scans stamped 0.030 s "
            "later than odometry");
}

TEST(MatchCountsTest, OnlyARefutedGyroscopeIsWarnedOf) {
  MatchRecord record;
  for (const auto state : {MatchRecord::NO_GYROSCOPE, MatchRecord::UNPROVEN,
                           MatchRecord::PROVEN}) {
    MatchCounts counts;
    record.set_gyroscope(state);
    counts.Add(record);
    EXPECT_EQ(WarningOfGyroscope(counts), "") << state;
  }
  record.set_gyroscope(MatchRecord::REFUTED);
  record.set_gyroscope_factor(-1.004);
  record.set_gyroscope_factor_sigma(0.01);
  MatchCounts counts;
  counts.Add(record);
  EXPECT_EQ(WarningOfGyroscope(counts),
            "the gyroscope of the IMU contradicts the scans, which turn by "
            "-1.00 +- 0.01 of what it measures: it is not used; check its "
            "mount, sign, unit and stamps");
}

TEST(MatchCountsTest, NoScansAreNoShare) {
  EXPECT_EQ(ToText(MatchCounts()).substr(0, 32),
            "0 scans, 0.0 % of them degenerat");
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
