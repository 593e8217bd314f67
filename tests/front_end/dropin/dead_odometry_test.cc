// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// A driver that publishes zeros, or a log whose format cannot leave odometry out.
#include <algorithm>

#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using test::RunDrive;
using test::RunOptions;
using test::RunResult;

// Five seconds at rest, then through the room.
RunOptions AfterARest() {
  RunOptions options;
  options.path = [](const double t) {
    return test::Path(std::max(0., t - 5.));
  };
  return options;
}

TEST(DeadOdometryTest, IsNotUsed) {
  RunOptions options = AfterARest();
  options.odometry = [](const double) { return Pose2(); };
  const RunResult result = RunDrive(options);
  for (const proto::MatchRecord& record : result.records) {
    EXPECT_NE(record.source(), proto::MatchRecord::ODOMETRY);
  }
  EXPECT_LT(result.max_error, 0.1);
}

TEST(DeadOdometryTest, IsUsedOnceItMoves) {
  RunOptions options = AfterARest();
  // The wheels are counted from a second after the start.
  options.odometry = [&](const double t) {
    return options.path(std::max(6., t));
  };
  const RunResult result = RunDrive(options);
  EXPECT_EQ(result.records.back().source(), proto::MatchRecord::ODOMETRY);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
