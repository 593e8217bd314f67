// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// The laser's driver stalls while the robot turns: one scan has a stamp long
// after it was measured, and the others are lost.
#include <cmath>

#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kLastBefore = 20.55;  // seconds
constexpr double kMeasured = 20.7, kDelivered = 21.3;

Pose2 Drive(const double t) {
  return Pose2(1.5 * std::sin(0.25 * t), 0.5 * std::sin(0.5 * t) - 0.5,
               0.9 * std::sin(1.2 * t));
}

// `field_of_view` in radians.
test::RunResult RunWithLateScan(const double field_of_view) {
  test::RunOptions run;
  run.field_of_view = field_of_view;
  run.odometry = Drive;
  run.path = [](const double t) {
    return Drive(std::abs(t - kDelivered) < 0.04 ? kMeasured : t);
  };
  run.has_scan = [](const double t) {
    return t < kLastBefore || t > kDelivered - 0.04;
  };
  return test::RunDrive(run);
}

TEST(LateScanTest, DoesNotTurnTheMap) {
  for (const double degrees : {57., 120., 240., 360.}) {
    const test::RunResult result = RunWithLateScan(DegToRad(degrees));
    EXPECT_GE(test::Count(result.records, proto::MatchRecord::JUMPING), 1)
        << degrees;
    EXPECT_LT(result.max_turn_error, 0.05) << degrees;
    EXPECT_LT(result.max_error, 0.1) << degrees;
    EXPECT_EQ(result.records.back().odometry(), proto::MatchRecord::OK)
        << degrees;
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
