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

// Five seconds at rest, then slowly through the room.
RunOptions AfterARest() {
  RunOptions options;
  options.path = [](const double t) {
    return test::Path(0.4 * std::max(0., t - 5.));
  };
  return options;
}

TEST(DeadOdometryTest, IsNotUsed) {
  RunOptions options = AfterARest();
  options.odometry = [](const double) { return Pose2(); };
  const RunResult result = RunDrive(options);
  int num_by_odometry = 0;
  for (const proto::MatchRecord& record : result.records) {
    num_by_odometry += record.source() == proto::MatchRecord::ODOMETRY;
  }
  // While it stood, and until it was clear that it moved.
  EXPECT_GT(num_by_odometry, 45);
  EXPECT_LT(num_by_odometry, 60);
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
