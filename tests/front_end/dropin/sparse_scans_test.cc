// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Local SLAM of recordings with a scan every metre.
#include <cmath>

#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using test::RunDrive;
using test::RunOptions;
using test::RunResult;

// A search looks at every scan. Matches that agree with the odometry tell of it
// nevertheless: along the corridor it is given more credit than at first.
TEST(SparseScansTest, GoodOdometryIsGivenCredit) {
  RunOptions options;
  options.walls = test::Corridor();
  options.path = [](const double t) { return Pose2(0.2 * t, 0.1, 0.); };
  options.odometry = options.path;
  options.has_scan = [](const double t) {
    return std::abs(std::remainder(t, 5.)) < 0.01;
  };
  options.seconds = 75.;
  options.max_range = 10.;
  const RunResult result = RunDrive(options);
  ASSERT_EQ(result.records.size(), 16u);
  EXPECT_NEAR(result.last.x, 15., 0.1);
  for (size_t i = 2; i < 6; ++i) {
    EXPECT_TRUE(result.records[i].searched());
  }
  const auto along = [&](const size_t i) {
    return result.records[i].covariance(0);
  };
  EXPECT_LT(along(15), 0.9 * along(2));
}

// A scan that hardly fits is where the odometry put it: the loop closure is told.
TEST(SparseScansTest, AScanThatHardlyFitsIsDoubted) {
  RunOptions options;
  options.path = [](const double t) { return test::Path(0.5 * t); };
  options.odometry = options.path;
  options.has_scan = [](const double t) {
    return std::abs(std::remainder(t, 2.)) < 0.01;
  };
  options.is_crowded = [](const double t) { return std::abs(t - 30.) < 0.01; };
  options.seconds = 40.;
  const RunResult result = RunDrive(options);
  ASSERT_EQ(result.records.size(), 21u);
  for (size_t i = 0; i < result.records.size(); ++i) {
    if (i == 15) {
      EXPECT_GT(result.doubts[i], 1e-6) << result.records[i].score();
    } else {
      EXPECT_EQ(result.doubts[i], 0.) << i << " " << result.records[i].score();
    }
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
