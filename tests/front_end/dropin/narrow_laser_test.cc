// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Local SLAM with the view of a depth camera.
#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using test::RunDrive;
using test::RunOptions;
using test::RunResult;

RunOptions NarrowLaser() {
  RunOptions options;
  options.max_range = 4.5;
  options.field_of_view = DegToRad(57.);
  options.own.prediction.calibration.estimate_odometry_scale = false;
  return options;
}

// Every scan sees on by what the robot has moved, where the map ends. It fits
// better where the robot has moved less, unless what nobody has seen is left
// undecided. Nor may it overrule the odometry: the robot would be held for
// standing still, for good.
TEST(NarrowLaserTest, ACorridorKeepsItsLength) {
  RunOptions run = NarrowLaser();
  run.walls = test::Corridor();
  for (int i = 0; i < 20; ++i) {
    const double x = 2.9 * i + 1.3, y = i % 2 == 0 ? 1.2 : -1.2;
    const double to = 0.9 * y;
    run.walls.push_back({{x, y}, {x, to}});
    run.walls.push_back({{x, to}, {x + 0.12, to}});
    run.walls.push_back({{x + 0.12, to}, {x + 0.12, y}});
  }
  double sum = 0.;
  int runs = 0;
  for (const double speed : {0.46, 0.48, 0.5, 0.52, 0.54, 0.56}) {
    run.path = run.odometry = [speed](const double t) {
      return Pose2(speed * t, 0., 0.);
    };
    // The first metres tell that it is the laser's sight that ends.
    run.seconds = 30.;
    const RunResult half = RunDrive(run);
    run.seconds = 80.;
    const RunResult whole = RunDrive(run);
    const double ratio = (whole.last.x - half.last.x) / (50. * speed);
    EXPECT_NEAR(ratio, 1., 0.015) << speed;
    sum += ratio;
    ++runs;
  }
  EXPECT_NEAR(sum / runs, 1., 0.006);
}

// Wheels that spin for three seconds turn the odometry by 1.8 rad, faster than
// scans of so narrow a view refute it one by one.
TEST(NarrowLaserTest, WheelSlipDoesNotTurnTheMap) {
  for (const double rate : {0.6, -0.6}) {
    RunOptions run = NarrowLaser();
    run.path = [](const double t) { return test::Path(0.6 * t); };
    const Pose2 at = run.path(15.);
    run.odometry = [&](const double t) {
      const double slip = std::min(3., std::max(0., t - 15.));
      return at * Pose2(0.3 * slip, 0., rate * slip) * at.Inverse() *
             run.path(t);
    };
    const RunResult result = RunDrive(run);
    EXPECT_LT(result.max_turn_error, 0.25) << rate;  // of a scan alone
    const Pose2 error = Between(result.true_last, result.last);
    EXPECT_LT(std::abs(error.theta), 0.05) << rate;
    EXPECT_LT(std::hypot(error.x, error.y), 0.2) << rate;
    EXPECT_GT(test::Count(result.records, proto::MatchRecord::SLIPPING), 5) << rate;
    EXPECT_EQ(result.records.back().source(), proto::MatchRecord::ODOMETRY);
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
