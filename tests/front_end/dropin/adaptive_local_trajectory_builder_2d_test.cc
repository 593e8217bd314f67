// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dropin/adaptive_local_trajectory_builder_2d.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "absl/memory/memory.h"
#include "cartographer/transform/transform.h"
#include "cartographer_ext/common/pose_graph_context.h"
#include "cartographer_ext/front_end/match_recorder.h"
#include "gtest/gtest.h"
#include "tests/front_end/dropin/simulated_drive.h"
#include "tests/front_end/dropin/simulated_room.h"

namespace cartographer_ext {
namespace front_end {
namespace {

using cartographer::mapping::proto::LocalTrajectoryBuilderOptions2D;
using proto::MatchRecord;
using test::Count;
using test::Path;
using test::RunDrive;
using test::RunOptions;
using test::RunResult;
using test::StockOptions;
using test::ToPose2;
using test::Wall;

TEST(AdaptiveLocalTrajectoryBuilder2DTest, FollowsARobotWithOdometry) {
  const RunResult result = RunDrive(RunOptions());
  EXPECT_EQ(result.matched, 401);
  EXPECT_GT(result.nodes, 50);
  EXPECT_LT(result.nodes, 401);
  EXPECT_LT(result.max_error, 0.05);
  EXPECT_LT(result.max_turn_error, 0.02);
  ASSERT_EQ(result.records.size(), 401);
  EXPECT_EQ(Count(result.records, MatchRecord::OK), 401);
  int nodes = 0;
  for (const MatchRecord& record : result.records) nodes += record.is_node();
  EXPECT_EQ(nodes, result.nodes);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, FollowsARobotWithoutOdometry) {
  RunOptions options;
  options.use_odometry = false;
  // Sets off gently.
  options.path = [](const double t) {
    return Path(t < 4. ? 0.125 * t * t : t - 2.);
  };
  const RunResult result = RunDrive(options);
  EXPECT_LT(result.max_error, 0.06);
  EXPECT_LT(result.max_turn_error, 0.03);
  EXPECT_EQ(result.records.back().odometry(), MatchRecord::ABSENT);
}

// A scan every 0.8 m fills a submap along the same path as one every 0.2 m, and
// the host sees every submap when it is finished.
TEST(AdaptiveLocalTrajectoryBuilder2DTest, SparseScansFillSubmapsByTheMetre) {
  LocalTrajectoryBuilderOptions2D stock = StockOptions();
  stock.mutable_submaps_options()->set_num_range_data(10);
  stock.mutable_motion_filter_options()->set_max_distance_meters(0.2);
  AdaptiveLocalTrajectoryBuilder2D builder(stock, FrontEndOptions(), {"scan"});
  Random random(7);
  int finished = 0;
  const cartographer::mapping::Submap2D* front = nullptr;
  for (int i = 0; i <= 40; ++i) {
    // To and fro, and a little to the side.
    const double phase = std::abs(i % 8 - 4) * 0.8 - 1.6;
    const Pose2 pose(phase, 0.02 * i - 0.5, 0.);
    builder.AddOdometryData(test::Odometry(i, pose));
    const auto matched = builder.AddRangeData(
        "scan", test::Scan(test::Room(), i, pose, 12., &random));
    ASSERT_NE(matched, nullptr);
    ASSERT_NE(matched->insertion_result, nullptr);
    const auto& submaps = matched->insertion_result->insertion_submaps;
    EXPECT_LE(submaps.back()->num_range_data(), 10);
    if (front != nullptr && submaps.front().get() != front) {
      // The one before was finished at a scan that was inserted into it.
      EXPECT_GE(finished, 1);
    }
    front = submaps.front().get();
    finished += submaps.front()->insertion_finished();
  }
  // 40 times 0.8 m in submaps that begin every 2 m.
  EXPECT_GE(finished, 11);
  EXPECT_LE(finished, 14);
}

// Half a round wall hardly determines a rotation about its centre. Whoever
// begins one there by chance must not go on with it.
TEST(AdaptiveLocalTrajectoryBuilder2DTest, NoTurnIsInventedWithinARoundWall) {
  LocalTrajectoryBuilderOptions2D stock = StockOptions();
  stock.mutable_submaps_options()->set_num_range_data(4);
  Random random(7);
  std::vector<double> errors;
  for (int run = 0; run < 21; ++run) {
    AdaptiveLocalTrajectoryBuilder2D builder(stock, FrontEndOptions(),
                                             {"scan"});
    const Pose2 start(random.Uniform(-1.5, 1.5), random.Uniform(0., 2.4),
                      random.Uniform(-kPi, kPi));
    const double heading = random.Uniform(-kPi, kPi);
    Pose2 first, last, truth;
    for (int i = 0; i < 40; ++i) {
      const double distance = 0.03 * i;
      truth =
          Pose2(distance * std::cos(heading), distance * std::sin(heading), 0.);
      const Pose2 to_robot = (start * truth).Inverse();
      cartographer::sensor::TimedPointCloudData scan;
      scan.time = test::At(0.1 * i);
      scan.origin = Eigen::Vector3f::Zero();
      for (double angle = 0.; angle < kPi; angle += 0.01) {
        const double range = 5. + random.Normal(0., 0.005);
        const Pose2 point = to_robot * Pose2(range * std::cos(angle),
                                             range * std::sin(angle), 0.);
        cartographer::sensor::TimedRangefinderPoint seen;
        seen.position = Eigen::Vector3f(static_cast<float>(point.x),
                                        static_cast<float>(point.y), 0.f);
        seen.time = 0.f;
        scan.ranges.push_back(seen);
      }
      const auto matched = builder.AddRangeData("scan", scan);
      ASSERT_NE(matched, nullptr);
      last = ToPose2(matched->local_pose);
      if (i == 0) first = last;
    }
    const Pose2 error = Between(truth, Between(first, last));
    errors.push_back(std::hypot(error.x, error.y));
  }
  std::sort(errors.begin(), errors.end());
  // 1.17 m were driven.
  EXPECT_LT(errors[10], 0.06);
  EXPECT_LT(errors[18], 0.25);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, NoTurnIsInventedInAGap) {
  // The robot turns left at 1 rad/s before the gap of 3 s, right within it.
  const auto path = [](const double t) {
    return Pose2(0., -0.5, t < 10. ? 0.2 * t : 2. - 0.5 * (t - 10.));
  };
  RunOptions options;
  options.path = path;
  options.odometry = path;
  options.seconds = 20.;
  options.has_scan = [](const double t) { return t < 10. || t > 13.; };
  const RunResult with_odometry = RunDrive(options);
  EXPECT_LT(with_odometry.max_turn_error, 0.03);
  EXPECT_LT(with_odometry.max_error, 0.05);
}

// A hole in everything, in which the robot turns about, in the middle of a room
// that looks the same then. Odometry comes back 0.15 s after the scans.
RunOptions AHoleInEverything() {
  RunOptions options;
  options.walls = {{{-4., -3.}, {4., -3.}},
                   {{4., -3.}, {4., 3.}},
                   {{4., 3.}, {-4., 3.}},
                   {{-4., 3.}, {-4., -3.}}};
  options.path = [](const double t) {
    return Pose2(0., 0., kPi * std::min(1., std::max(0., (t - 10.) / 3.)));
  };
  options.odometry = options.path;
  options.seconds = 16.;
  options.has_scan = [](const double t) { return t < 10.05 || t > 12.95; };
  options.has_odometry = [](const double t) {
    return t < 10.01 || (t > 13.12);
  };
  return options;
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, ScansBehindAGapWaitForOdometry) {
  const RunResult result = RunDrive(AHoleInEverything());
  // The scans at 13.0 and 13.1 s are dropped.
  EXPECT_EQ(result.matched, 101 + 31 - 2);
  EXPECT_EQ(result.records.size(), result.matched);
  EXPECT_LT(result.max_turn_error, 0.03);
  EXPECT_LT(result.max_error, 0.05);
  RunOptions hasty = AHoleInEverything();
  hasty.own.max_wait_after_gap = 0.;
  EXPECT_GT(RunDrive(hasty).max_turn_error, 3.);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, ScansBehindAGapDoNotWaitForEver) {
  RunOptions options = AHoleInEverything();
  options.has_odometry = [](const double t) { return t < 10.01; };
  EXPECT_EQ(RunDrive(options).matched, 101 + 31 - 5);
  options.own.max_wait_after_gap = 0.;
  EXPECT_EQ(RunDrive(options).matched, 101 + 31);
  // Without odometry nothing is waited for.
  options.own = FrontEndOptions();
  options.use_odometry = false;
  EXPECT_EQ(RunDrive(options).matched, 101 + 31);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest,
     AfterAGapWithoutAnythingItLooksAround) {
  // A translation of 0.4 m and a rotation of 75 degrees that neither scans nor
  // odometry have seen.
  const auto path = [](const double t) {
    // Sets off gently.
    const double driven = t < 4.    ? 0.125 * t * t
                          : t < 20. ? t - 2.
                                    : std::max(18., t - 5.);
    const double gap = std::min(1., std::max(0., (t - 20.) / 3.));
    const Pose2 pose = Path(driven);
    return Pose2(pose.x + 0.3 * gap, pose.y - 0.25 * gap,
                 pose.theta - 1.3 * gap);
  };
  RunOptions options;
  options.path = path;
  options.use_odometry = false;
  options.seconds = 26.;
  options.has_scan = [](const double t) { return t <= 20. || t > 23.; };
  const RunResult result = RunDrive(options);
  EXPECT_LT(result.max_error, 0.06);
  EXPECT_LT(result.max_turn_error, 0.03);
  EXPECT_EQ(Count(result.records, MatchRecord::ABSENT), result.matched - 1);
}

// From a single scan in the map, with slow first steps, along walls that show
// hardly more than themselves: the dots of the first scan must not hold the
// robot back.
TEST(AdaptiveLocalTrajectoryBuilder2DTest, SetsOffFromItsFirstScan) {
  RunOptions options;
  options.walls.clear();
  for (const double side : {-1., 1.}) {
    for (int i = -10; i < 10; ++i) {
      const double x = 3.6 * i + 0.4 * side;
      const std::vector<Eigen::Vector2d> line = {{x, 1.2 * side},
                                                 {x + 2.7, 1.2 * side},
                                                 {x + 2.7, 1.35 * side},
                                                 {x + 3.6, 1.35 * side},
                                                 {x + 3.6, 1.2 * side}};
      for (size_t k = 1; k < line.size(); ++k) {
        options.walls.push_back({line[k - 1], line[k]});
      }
    }
  }
  options.path = [](const double t) {
    const double driving = std::max(0., t - 1.);
    return Pose2(driving < 2. ? 0.2 * driving * driving : 0.8 * driving - 0.8,
                 0., 0.);
  };
  options.odometry = options.path;
  options.seconds = 6.;
  options.max_range = 25.;
  const RunResult result = RunDrive(options);
  EXPECT_LT(result.max_error, 0.09);
  EXPECT_EQ(Count(result.records, MatchRecord::OK), result.matched);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, StaleOdometryIsBridgedAndTold) {
  const double clean = RunDrive(RunOptions()).mean_error;
  RunOptions options;
  options.odometry = [](const double t) {
    return Path(t > 20. && t < 21. ? 20. : t);
  };
  const RunResult result = RunDrive(options);
  EXPECT_LT(result.mean_error, 1.5 * clean + 0.002);
  EXPECT_GT(Count(result.records, MatchRecord::STALE), 3);
  EXPECT_EQ(result.records.back().odometry(), MatchRecord::OK);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, AJumpIsBridgedAndTold) {
  const double clean = RunDrive(RunOptions()).mean_error;
  RunOptions options;
  options.odometry = [](const double t) {
    return t < 20.02 ? Path(t) : Pose2(0.7, 0.5, 0.4) * Path(t);
  };
  const RunResult result = RunDrive(options);
  EXPECT_LT(result.mean_error, 1.5 * clean + 0.002);
  EXPECT_GE(Count(result.records, MatchRecord::JUMPING), 1);
  EXPECT_EQ(result.records.back().odometry(), MatchRecord::OK);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, TheClockOffsetIsLearnt) {
  RunOptions options;
  options.path = [](const double t) {
    return Pose2(1.5 * std::sin(0.25 * t), 0.5 * std::sin(0.5 * t) - 0.5,
                 0.9 * std::sin(1.2 * t));
  };
  options.odometry = [&options](const double t) {
    return options.path(t + 0.15);
  };
  options.seconds = 60.;
  const RunResult result = RunDrive(options);
  EXPECT_NEAR(result.records.back().time_offset(), 0.15, 0.02);
  EXPECT_LT(result.max_error, 0.06);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, ACorridorKeepsTheLengthOfOdometry) {
  RunOptions options;
  options.walls = test::Corridor();
  // IsStationary, sets off with 0.4 m/s^2, and goes at 0.4 m/s.
  options.path = [](const double t) {
    const double moving = std::max(0., t - 2.);
    return Pose2(moving < 1. ? 0.2 * moving * moving : 0.4 * moving - 0.2, 0.1,
                 0.);
  };
  options.odometry = options.path;
  options.max_range = 10.;
  const RunResult result = RunDrive(options);
  // 15 m along a blank corridor.
  EXPECT_NEAR(result.last.x, 15., 0.2);
  EXPECT_NEAR(result.last.y, 0., 0.03);
  int degenerate = 0;
  double worst_direction = 0.;
  for (const MatchRecord& record : result.records) {
    if (record.degeneracy() != MatchRecord::TRANSLATION) continue;
    ++degenerate;
    const double off = std::abs(std::remainder(record.weak_direction(), kPi));
    worst_direction = std::max(worst_direction, off);
  }
  EXPECT_GT(degenerate, 350);
  EXPECT_LT(worst_direction, DegToRad(5.));
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, FeaturesDoTheJob) {
  RunOptions options;
  options.own.match_features_only = true;
  const RunResult result = RunDrive(options);
  EXPECT_LT(result.max_error, 0.1);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, SeveralSweepsMakeAScan) {
  RunOptions options;
  options.stock.set_num_accumulated_range_data(2);
  const RunResult result = RunDrive(options);
  EXPECT_EQ(result.matched, 200);
  EXPECT_LT(result.max_error, 0.06);
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, RepeatsItselfBitForBit) {
  const RunResult a = RunDrive(RunOptions()), b = RunDrive(RunOptions());
  EXPECT_EQ(a.last.x, b.last.x);
  EXPECT_EQ(a.last.theta, b.last.theta);
  ASSERT_EQ(a.records.size(), b.records.size());
  for (size_t i = 0; i < a.records.size(); ++i) {
    EXPECT_EQ(a.records[i].SerializeAsString(),
              b.records[i].SerializeAsString());
  }
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, BadScansAreSurvived) {
  AdaptiveLocalTrajectoryBuilder2D builder(StockOptions(), FrontEndOptions(),
                                           {"scan"});
  Random random(1);
  cartographer::sensor::TimedPointCloudData scan =
      test::Scan(test::Room(), 1., Path(0.), 12., &random);
  EXPECT_NE(builder.AddRangeData("scan", scan), nullptr);
  // Not later.
  EXPECT_EQ(builder.AddRangeData("scan", scan), nullptr);
  // Without points, with one, with ranges that are not a number.
  cartographer::sensor::TimedPointCloudData empty = scan;
  empty.time = test::At(2.);
  empty.ranges.clear();
  EXPECT_EQ(builder.AddRangeData("scan", empty), nullptr);
  cartographer::sensor::TimedPointCloudData one = scan;
  one.time = test::At(3.);
  one.ranges.resize(1);
  const auto matched = builder.AddRangeData("scan", one);
  ASSERT_NE(matched, nullptr);
  EXPECT_TRUE(matched->local_pose.translation().allFinite());
  cartographer::sensor::TimedPointCloudData broken = scan;
  broken.time = test::At(4.);
  for (auto& point : broken.ranges) {
    point.position.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  EXPECT_EQ(builder.AddRangeData("scan", broken), nullptr);
  scan.time = test::At(5.);
  const auto after = builder.AddRangeData("scan", scan);
  ASSERT_NE(after, nullptr);
  EXPECT_TRUE(after->local_pose.translation().allFinite());
}

TEST(AdaptiveLocalTrajectoryBuilder2DTest, TheImuTurnsTheRobotAndLevelsIt) {
  LocalTrajectoryBuilderOptions2D stock = StockOptions();
  stock.set_use_imu_data(true);
  AdaptiveLocalTrajectoryBuilder2D builder(stock, FrontEndOptions(), {"scan"});
  Random random(2);
  // Turns on the spot at 0.5 rad/s, tilted by 3 degrees.
  const Eigen::Quaterniond tilt(
      Eigen::AngleAxisd(DegToRad(3.), Eigen::Vector3d::UnitX()));
  EXPECT_EQ(builder.AddRangeData(
                "scan", test::Scan(test::Room(), -1., Pose2(), 12., &random)),
            nullptr);  // waits for the IMU
  for (int i = 0; i <= 500; ++i) {
    const double t = 0.01 * i;
    cartographer::sensor::ImuData imu;
    imu.time = test::At(t);
    imu.linear_acceleration =
        tilt.conjugate() * Eigen::Vector3d(0., 0., 9.80665);
    imu.angular_velocity = tilt.conjugate() * Eigen::Vector3d(0., 0., 0.5);
    builder.AddImuData(imu);
    if (i % 10 != 0) continue;
    auto scan =
        test::Scan(test::Room(), t, Pose2(0., -0.5, 0.5 * t), 12., &random);
    for (auto& point : scan.ranges) {
      point.position = tilt.conjugate().cast<float>() * point.position;
    }
    const auto matched = builder.AddRangeData("scan", scan);
    ASSERT_NE(matched, nullptr);
    EXPECT_NEAR(
        std::remainder(ToPose2(matched->local_pose).theta - 0.5 * t, 2. * kPi),
        0., 0.03);
    if (matched->insertion_result != nullptr) {
      const Eigen::Quaterniond alignment =
          matched->insertion_result->constant_data->gravity_alignment;
      EXPECT_LT(alignment.angularDistance(tilt), 0.02);
    }
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
