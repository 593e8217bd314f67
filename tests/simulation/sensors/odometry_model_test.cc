// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/odometry_model.h"

#include <cmath>
#include <string>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

using Kind = OdometryFault::Kind;

constexpr char kCurvyDrive[] =
    "start 2 1 40\nwait 1\ngoto 6 2\ngoto 8 6\ngoto 3 8\nreverse 5 8\nturn 0\n";
constexpr char kStraightDrive[] = "start 0 0 0\ngoto 20 0\n";

struct Recording {
  World world;
  Drive drive;
  OdometryRun odometry;
};

Recording Simulate(const std::string& text, const uint64_t seed = 0) {
  auto world = ParseWorld(text, "test.world");
  EXPECT_TRUE(world.ok()) << world.status();
  auto drive = Drive::Plan(*world, seed);
  EXPECT_TRUE(drive.ok()) << drive.status();
  OdometryRun odometry = SimulateOdometry(*world, *drive, world->faults, seed);
  return {*world, *std::move(drive), std::move(odometry)};
}

Pose2 TruthAt(const Recording& run, const io::OdometryReading& reading) {
  return Between(run.world.start, run.drive.PoseAt(io::ToSeconds(reading.time) -
                                                   run.world.begin));
}

// The pose reported for a time in seconds since the start.
Pose2 ReportedAt(const Recording& run, const double time) {
  const io::TimeNs stamp = io::FromSeconds(run.world.begin + time);
  Pose2 pose;
  for (const io::OdometryReading& reading : run.odometry.readings) {
    if (reading.time > stamp + 1000) break;
    pose = reading.pose;
  }
  return pose;
}

TEST(OdometryModelTest, WithoutErrorsItIsTheTruth) {
  const Recording run =
      Simulate(std::string(kCurvyDrive) + "odometry rate=20 encoder_rate=1000");
  ASSERT_GT(run.odometry.readings.size(), 500);
  EXPECT_TRUE(run.odometry.labels.empty());
  for (const io::OdometryReading& reading : run.odometry.readings) {
    const Pose2 truth = TruthAt(run, reading);
    ASSERT_NEAR(reading.pose.x, truth.x, 1e-5);
    ASSERT_NEAR(reading.pose.y, truth.y, 1e-5);
    ASSERT_NEAR(NormalizeAngle(reading.pose.theta - truth.theta), 0., 1e-9);
  }
}

TEST(OdometryModelTest, StampsFollowRateAndPhase) {
  const Recording run = Simulate(std::string(kStraightDrive) +
                                 "begin 50\nodometry rate=25 phase=0.013");
  const auto& readings = run.odometry.readings;
  ASSERT_GT(readings.size(), 100);
  EXPECT_EQ(readings[0].time, 50013000000);
  for (size_t i = 1; i < readings.size(); ++i) {
    ASSERT_NEAR(readings[i].time - readings[i - 1].time, 40000000, 1);
  }
}

TEST(OdometryModelTest, SystematicScales) {
  // Both wheels 3 % too long: the distance is 3 % too long.
  const Recording scaled =
      Simulate(std::string(kStraightDrive) +
               "odometry scale_left=0.03 scale_right=0.03");
  const double length = scaled.drive.length();
  EXPECT_NEAR(scaled.odometry.readings.back().pose.x, 1.03 * length, 0.01);
  // One per mille between the wheels, 0.4 m apart: 2.5 mrad a metre.
  const Recording bent =
      Simulate(std::string(kStraightDrive) +
               "odometry scale_left=-0.0005 scale_right=0.0005 wheel_base=0.4");
  EXPECT_NEAR(bent.odometry.readings.back().pose.theta, 0.0025 * length, 1e-4);
  // A wheel base believed 10 % too wide turns 1 / 1.1 of the truth.
  const Recording wide =
      Simulate("start 0 0 0\nturn 120\nodometry wheel_base_error=0.1");
  EXPECT_NEAR(wide.odometry.readings.back().pose.theta,
              wide.drive.PoseAt(1e3).theta / 1.1, 5e-3);
}

TEST(OdometryModelTest, TicksRoundDown) {
  const Recording run =
      Simulate(std::string(kStraightDrive) + "odometry ticks_per_metre=10");
  for (const io::OdometryReading& reading : run.odometry.readings) {
    const double ticks = reading.pose.x * 10.;
    ASSERT_NEAR(ticks, std::round(ticks), 1e-6);
    ASSERT_LE(reading.pose.x, TruthAt(run, reading).x + 1e-9);
    ASSERT_GT(reading.pose.x, TruthAt(run, reading).x - 0.1 - 1e-9);
  }
}

// Noise of n per square root of a metre and wheel: over L metres the distance
// has the variance n^2 L / 2 and the heading 2 n^2 L / b^2.
TEST(OdometryModelTest, NoiseGrowsWithTheRootOfTheWay) {
  const double noise = 0.01, base = 0.4;
  double way_squares = 0., angle_squares = 0.;
  const int kRuns = 400;
  double length = 0.;
  auto world = ParseWorld(
      "start 0 0 0\ngoto 8 0\nodometry noise=0.01 encoder_rate=20", "t");
  ASSERT_TRUE(world.ok());
  const auto drive = Drive::Plan(*world, 0);
  ASSERT_TRUE(drive.ok());
  for (int seed = 0; seed != kRuns; ++seed) {
    const OdometryRun run = SimulateOdometry(*world, *drive, {}, seed);
    length = drive->length();
    angle_squares += std::pow(run.readings.back().pose.theta, 2);
    // To first order the distance is what heading errors cannot shorten.
    way_squares += std::pow(run.readings.back().pose.x - length +
                                0.25 * std::pow(noise / base * length, 2),
                            2);
  }
  const double angle_sigma = std::sqrt(angle_squares / kRuns);
  EXPECT_NEAR(angle_sigma, std::sqrt(2. * length) * noise / base,
              0.12 * angle_sigma);
  const double way_sigma = std::sqrt(way_squares / kRuns);
  EXPECT_NEAR(way_sigma, noise * std::sqrt(0.5 * length), 0.5 * way_sigma);
}

TEST(OdometryModelTest, RunsDifferByTheirScales) {
  double sum = 0., squares = 0., mismatch_squares = 0.;
  const int kRuns = 500;
  auto world = ParseWorld(
      "start 0 0 0\nodometry scale_sigma=0.02 mismatch_sigma=0.005", "t");
  ASSERT_TRUE(world.ok());
  const auto drive = Drive::Plan(*world, 0);
  for (int seed = 0; seed != kRuns; ++seed) {
    const OdometryRun run = SimulateOdometry(*world, *drive, {}, seed);
    const double common = 0.5 * (run.scale_left + run.scale_right);
    sum += common;
    squares += common * common;
    mismatch_squares += std::pow(run.scale_right - run.scale_left, 2);
  }
  EXPECT_NEAR(sum / kRuns, 0., 0.003);
  EXPECT_NEAR(std::sqrt(squares / kRuns), 0.02, 0.002);
  EXPECT_NEAR(std::sqrt(mismatch_squares / kRuns), 0.005, 0.0005);
}

TEST(OdometryFaultTest, SlipInATimeWindow) {
  // Both wheels turn half as much again for 2 s at 0.7 m/s.
  const Recording run =
      Simulate(std::string(kStraightDrive) +
               "fault slip start=10 duration=2 left=0.5 right=0.5");
  const double extra =
      0.5 * (run.drive.At(12.).distance - run.drive.At(10.).distance);
  EXPECT_NEAR(extra, 0.7, 0.01);
  EXPECT_NEAR(run.odometry.readings.back().pose.x, run.drive.length() + extra,
              0.03);
  ASSERT_EQ(run.odometry.labels.size(), 1);
  const FaultLabel& label = run.odometry.labels[0];
  EXPECT_EQ(label.kind, Kind::kSlip);
  EXPECT_NEAR(label.start, run.world.begin + 10., 0.06);
  EXPECT_NEAR(label.end, run.world.begin + 12., 0.06);
  EXPECT_NEAR(label.distance, extra, 0.03);
  EXPECT_NEAR(label.angle, 0., 1e-12);
}

TEST(OdometryFaultTest, SlipAtAPlaceTurnsTheRobot) {
  // The left wheel spins over 2 m of floor: heading error -gain * 2 / b.
  const Recording run = Simulate(std::string(kStraightDrive) +
                                 "odometry wheel_base=0.5\n"
                                 "fault slip x=10 y=0 radius=1 left=0.1");
  EXPECT_NEAR(run.odometry.readings.back().pose.theta, -0.1 * 2. / 0.5, 0.01);
  ASSERT_EQ(run.odometry.labels.size(), 1);
  EXPECT_NEAR(run.odometry.labels[0].angle, -0.4, 0.01);
  EXPECT_NEAR(run.odometry.labels[0].distance, 0.1, 0.005);
}

TEST(OdometryFaultTest, SpinWhileStanding) {
  const Recording run = Simulate(
      "start 0 0 0\nwait 10\n"
      "fault slip start=4 duration=3 spin_left=0.2 spin_right=0.2");
  EXPECT_NEAR(run.odometry.readings.back().pose.x, 0.6, 0.011);
}

TEST(OdometryFaultTest, StaleBurstRepeatsThenJumps) {
  const Recording run =
      Simulate(std::string(kStraightDrive) + "fault stale start=10 duration=1");
  const Pose2 held = ReportedAt(run, 9.96);
  EXPECT_EQ(ReportedAt(run, 10.1).x, held.x);
  EXPECT_EQ(ReportedAt(run, 10.9).x, held.x);
  // Afterwards nothing is lost.
  EXPECT_NEAR(ReportedAt(run, 11.5).x, run.drive.PoseAt(11.5).x, 1e-6);
  ASSERT_EQ(run.odometry.labels.size(), 1);
  const FaultLabel& label = run.odometry.labels[0];
  EXPECT_EQ(label.kind, Kind::kStale);
  EXPECT_NEAR(label.start, run.world.begin + 9.95, 0.051);
  EXPECT_NEAR(label.end, run.world.begin + 11., 0.051);
  EXPECT_NEAR(label.distance, 0.7 * 1.05, 0.05);
}

TEST(OdometryFaultTest, JumpMovesTheFrameForGood) {
  const Recording run = Simulate(std::string(kStraightDrive) +
                                 "fault jump start=10 distance=0.8 angle=90");
  const Pose2 before = ReportedAt(run, 9.96), after = ReportedAt(run, 10.01);
  EXPECT_NEAR(Between(before, after).theta, kPi / 2., 1e-9);
  EXPECT_NEAR(Between(before, after).x, 0.8 + 0.035, 0.01);
  // Then it drives on in the new direction.
  EXPECT_NEAR(ReportedAt(run, 15.).y - after.y,
              run.drive.At(15.).distance - run.drive.At(10.).distance, 1e-3);
  ASSERT_EQ(run.odometry.labels.size(), 1);
  EXPECT_EQ(run.odometry.labels[0].distance, 0.8);
  EXPECT_NEAR(run.odometry.labels[0].end - run.odometry.labels[0].start, 0.05,
              1e-6);
}

TEST(OdometryFaultTest, ReverseIsReportedForwards) {
  const Recording run =
      Simulate("start 0 0 0\ngoto 4 0\nreverse 1 0\nfault reverse");
  EXPECT_NEAR(run.odometry.readings.back().pose.x, run.drive.length(), 0.05);
  ASSERT_EQ(run.odometry.labels.size(), 1);
  EXPECT_NEAR(run.odometry.labels[0].distance, 6., 0.1);
}

TEST(OdometryFaultTest, OffsetShowsTheFuture) {
  const Recording run = Simulate(std::string(kStraightDrive) +
                                 "fault offset seconds=0.15\nodometry rate=20");
  EXPECT_NEAR(ReportedAt(run, 10.).x, run.drive.PoseAt(10.15).x, 1e-6);
  const Recording late =
      Simulate(std::string(kStraightDrive) +
               "fault offset seconds=-0.1\nodometry rate=20");
  EXPECT_NEAR(ReportedAt(late, 10.).x, late.drive.PoseAt(9.9).x, 1e-6);
  EXPECT_EQ(late.odometry.readings.front().pose.x, 0.);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
