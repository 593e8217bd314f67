// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_monitor.h"

#include <algorithm>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kInterval = 0.1;

// A monitor and a clock.
class Drive {
 public:
  explicit Drive(const OdometryCheckOptions& options) : monitor_(options) {}

  OdometryState Step(const Pose2& odometry, const Pose2& match,
                     const bool frozen = false, const bool determined = true) {
    time_ += kInterval;
    MotionComparison comparison;
    comparison.time = time_;
    comparison.interval = kInterval;
    comparison.odometry = odometry;
    comparison.match = match;
    comparison.frozen = frozen;
    comparison.translation_observable = determined;
    return monitor_.Add(comparison);
  }

  // The state after some equal steps, and after how many it was first `state`.
  int StepsUntil(const OdometryState state, const Pose2& odometry,
                 const Pose2& match, const int limit) {
    for (int i = 1; i <= limit; ++i) {
      if (Step(odometry, match) == state) return i;
    }
    return -1;
  }

  OdometryMonitor* monitor() { return &monitor_; }

 private:
  OdometryMonitor monitor_;
  double time_ = 0.;
};

const Pose2 kForward(0.05, 0., 0.);
const Pose2 kStill;

TEST(OdometryMonitorTest, NoiseAndScaleErrorsAreNoFaults) {
  Drive drive((OdometryCheckOptions()));
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Pose2 match(0.05 + random.Normal(0., 0.01), random.Normal(0., 0.01),
                      0.02 + random.Normal(0., 0.003));
    EXPECT_EQ(drive.Step(Pose2(0.0515, 0., 0.0206), match), OdometryState::kOk);
  }
}

TEST(OdometryMonitorTest, AStaleBurstAndTheJumpBehindIt) {
  Drive drive((OdometryCheckOptions()));
  for (int i = 0; i < 20; ++i) drive.Step(kForward, kForward);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(drive.Step(kStill, kForward, true), OdometryState::kStale);
    EXPECT_FALSE(drive.monitor()->IsTrusted());
    // What odometry owes.
    EXPECT_NEAR(drive.monitor()->MissedMotion().x, -0.05 * (i + 1), 1e-9);
  }
  // It catches up with 6 steps in one, which belongs to the burst.
  const OdometryState catching_up = drive.Step(Pose2(0.6, 0., 0.), kForward);
  EXPECT_NE(catching_up, OdometryState::kOk);
  EXPECT_EQ(drive.Step(kForward, kForward), OdometryState::kOk);
  EXPECT_TRUE(drive.monitor()->IsTrusted());
  EXPECT_NEAR(drive.monitor()->MissedMotion().x, 0., 1e-9);
}

TEST(OdometryMonitorTest, StandingIsNotStale) {
  Drive drive((OdometryCheckOptions()));
  for (int i = 0; i < 20; ++i) drive.Step(kForward, kForward);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(drive.Step(kStill, Pose2(0.002, -0.001, 0.001), true),
              OdometryState::kOk);
  }
}

TEST(OdometryMonitorTest, AJumpIsOverAtOnce) {
  Drive drive((OdometryCheckOptions()));
  for (int i = 0; i < 20; ++i) drive.Step(kForward, kForward);
  EXPECT_EQ(drive.Step(Pose2(0.8, 0.1, 0.2), kForward),
            OdometryState::kJumping);
  // Where the odometry would be right if the scan had come late.
  const Pose2 missed = drive.monitor()->MissedMotion();
  EXPECT_NEAR(missed.x, 0.75, 1e-9);
  EXPECT_NEAR(missed.y, 0.1, 1e-9);
  EXPECT_NEAR(missed.theta, 0.2, 1e-9);
  EXPECT_EQ(drive.Step(kForward, kForward), OdometryState::kOk);
  EXPECT_NEAR(drive.monitor()->MissedMotion().x, 0., 1e-9);
}

TEST(OdometryMonitorTest, TheWrongSignInReverse) {
  Drive drive((OdometryCheckOptions()));
  for (int i = 0; i < 20; ++i) drive.Step(kForward, kForward);
  const int steps = drive.StepsUntil(OdometryState::kWrongSign, kForward,
                                     Pose2(-0.05, 0., 0.), 20);
  EXPECT_GT(steps, 0);
  EXPECT_LE(steps, 10);
  // Forwards again it recovers within the window.
  const int recovered =
      drive.StepsUntil(OdometryState::kOk, kForward, kForward, 30);
  EXPECT_GT(recovered, 0);
  EXPECT_LE(recovered, 12);
}

TEST(OdometryMonitorTest, SlipOfHalfTheWay) {
  Drive drive((OdometryCheckOptions()));
  for (int i = 0; i < 20; ++i) drive.Step(kForward, kForward);
  const int steps = drive.StepsUntil(OdometryState::kSlipping,
                                     Pose2(0.1, 0., 0.), kForward, 20);
  EXPECT_GT(steps, 0);
  EXPECT_LE(steps, 8);
}

TEST(OdometryMonitorTest, TurningSlip) {
  Drive drive((OdometryCheckOptions()));
  const int steps = drive.StepsUntil(OdometryState::kSlipping,
                                     Pose2(0.05, 0., 0.05), kForward, 20);
  EXPECT_GT(steps, 0);
  EXPECT_LE(steps, 8);
}

TEST(OdometryMonitorTest, SuddenSpeedInABlankCorridorIsReported) {
  OdometryCheckOptions options;
  options.max_acceleration = 1.;
  Drive drive(options);
  const Pose2 slow(0.03, 0., 0.), fast(0.06, 0., 0.);
  // The match follows the prediction, as it must where nothing is seen.
  for (int i = 0; i < 20; ++i) drive.Step(slow, slow, false, false);
  EXPECT_FALSE(drive.monitor()->suspects_slip());
  EXPECT_EQ(drive.Step(fast, fast, false, false), OdometryState::kOk);
  EXPECT_EQ(drive.Step(fast, fast, false, false),
            OdometryState::kSlipSuspected);
  EXPECT_TRUE(drive.monitor()->IsTrusted());
  EXPECT_EQ(drive.Step(slow, slow, false, false), OdometryState::kOk);
}

TEST(OdometryMonitorTest, WheelsThatSpinInABlankCorridorAreNotFollowed) {
  OdometryCheckOptions options;
  options.max_acceleration = 1.;
  Drive drive(options);
  const Pose2 slow(0.03, 0., 0.), fast(0.06, 0., 0.);
  for (int i = 0; i < 100; ++i) drive.Step(slow, slow);
  for (int i = 0; i < 20; ++i) drive.Step(slow, slow, false, false);
  EXPECT_EQ(drive.Step(fast, fast, false, false), OdometryState::kOk);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(drive.Step(fast, fast, false, false), OdometryState::kSlipping);
    EXPECT_TRUE(drive.monitor()->suspects_slip());
    EXPECT_NEAR(drive.monitor()->speed_before_slip(), 0.03 / kInterval, 1e-3);
  }
  EXPECT_FALSE(drive.monitor()->IsTrusted());
  EXPECT_EQ(drive.Step(slow, slow, false, false), OdometryState::kOk);
}

TEST(OdometryMonitorTest, WhereTheScanTellsTheWaySuddenSpeedIsNoSlip) {
  OdometryCheckOptions options;
  options.max_acceleration = 1.;
  Drive drive(options);
  const Pose2 slow(0.03, 0., 0.), fast(0.06, 0., 0.);
  for (int i = 0; i < 20; ++i) drive.Step(slow, slow);
  EXPECT_EQ(drive.Step(fast, fast), OdometryState::kOk);
}

TEST(OdometryMonitorTest, AnImuClearsTheRobotsOwnAcceleration) {
  OdometryCheckOptions options;
  options.max_acceleration = 1.;
  OdometryMonitor monitor(options);
  MotionComparison comparison;
  comparison.interval = kInterval;
  comparison.translation_observable = false;
  comparison.odometry = comparison.match = Pose2(0.03, 0., 0.);
  comparison.speeds = {{kInterval, 0.03 / kInterval, 0.}};
  comparison.time = 0.1;
  monitor.Add(comparison);
  comparison.odometry = comparison.match = Pose2(0.06, 0., 0.);
  comparison.speeds = {{kInterval, 0.06 / kInterval, 0.3}};
  comparison.time = 0.2;
  EXPECT_EQ(monitor.Add(comparison), OdometryState::kOk);
  comparison.speeds = {{kInterval, 0.09 / kInterval, 0.}};
  comparison.odometry = comparison.match = Pose2(0.09, 0., 0.);
  comparison.time = 0.3;
  EXPECT_EQ(monitor.Add(comparison), OdometryState::kOk);
  comparison.time = 0.4;  // it lasts
  EXPECT_EQ(monitor.Add(comparison), OdometryState::kSlipSuspected);
}

TEST(OdometryMonitorTest, AbsentOdometryIsToldAndStartsAnew) {
  Drive drive((OdometryCheckOptions()));
  MotionComparison comparison;
  comparison.time = 0.05;
  comparison.interval = kInterval;
  comparison.has_odometry = false;
  EXPECT_EQ(drive.monitor()->Add(comparison), OdometryState::kAbsent);
  EXPECT_FALSE(drive.monitor()->IsTrusted());
  EXPECT_EQ(drive.Step(kForward, kForward), OdometryState::kOk);
}

TEST(OdometryMonitorTest, SwitchedOffItFindsNothing) {
  OdometryCheckOptions options;
  options.enabled = false;
  Drive drive(options);
  EXPECT_FALSE(
      drive.monitor()->IsSuspect(0.1, Pose2(5., 0., 0.), false, kForward));
  EXPECT_EQ(drive.Step(Pose2(5., 0., 0.), kForward), OdometryState::kOk);
}

TEST(OdometryMonitorTest, SuspicionBeforeTheMatch) {
  const OdometryMonitor monitor((OdometryCheckOptions()));
  EXPECT_FALSE(monitor.IsSuspect(0.1, kForward, false, kForward));
  EXPECT_TRUE(monitor.IsSuspect(0.1, Pose2(0.5, 0., 0.), false, kForward));
  EXPECT_TRUE(monitor.IsSuspect(0.1, Pose2(0.05, 0., 0.5), false, kForward));
  EXPECT_TRUE(monitor.IsSuspect(0.1, kStill, true, kForward));
  // Stationary, as expected.
  EXPECT_FALSE(monitor.IsSuspect(0.1, kStill, true, kStill));
}

// Wheels that turn more than twice as far as the robot drives.
MotionComparison Slip() {
  MotionComparison comparison;
  comparison.interval = kInterval;
  comparison.odometry = kForward;
  comparison.match = Pose2(0.02, 0., 0.);
  return comparison;
}

// A scan that cannot tell the pose of the match from that of odometry is no
// witness of a fault.
TEST(OdometryMonitorTest, AFaultNeedsEvidence) {
  for (const double evidence : {6.9, 7.1}) {
    OdometryMonitor monitor((OdometryCheckOptions()));
    MotionComparison comparison = Slip();
    Pose2 error;
    comparison.evidence = [&](const Pose2& by) {
      error = by;
      return evidence;
    };
    int faults = 0;
    for (int i = 1; i <= 20; ++i) {
      comparison.time = i * kInterval;
      faults += monitor.Add(comparison) == OdometryState::kSlipping ? 1 : 0;
    }
    EXPECT_EQ(faults > 0, evidence > 7.);
    // Over the window of a second odometry has driven 0.3 m further.
    EXPECT_NEAR(error.x, 0.3, 0.04);
    // A jump likewise.
    comparison.time += kInterval;
    comparison.match = Pose2(0.5, 0., 0.);
    const OdometryState state = monitor.Add(comparison);
    EXPECT_EQ(state == OdometryState::kJumping, evidence > 7.);
  }
}

// One fault in two hundred metres before any, as many as there were afterwards; one
// that lasts is one.
TEST(OdometryMonitorTest, CountsFaultsPerMetre) {
  Drive drive((OdometryCheckOptions()));
  EXPECT_NEAR(drive.monitor()->faults_per_metre(), 1. / 200., 1e-12);
  for (int i = 0; i < 2000; ++i) drive.Step(kForward, kForward);
  EXPECT_NEAR(drive.monitor()->faults_per_metre(), 1. / 300., 1e-9);
  for (int k = 1; k <= 3; ++k) {
    ASSERT_GT(drive.StepsUntil(OdometryState::kSlipping, kForward, kStill, 50),
              0);
    for (int i = 0; i < 10; ++i) drive.Step(kForward, kStill);
    ASSERT_GT(drive.StepsUntil(OdometryState::kOk, kForward, kForward, 50), 0);
    for (int i = 0; i < 50; ++i) drive.Step(kForward, kForward);
  }
  EXPECT_NEAR(drive.monitor()->faults_per_metre(), 4. / 310., 5e-4);
}

// Once wheels slip, scans that would not have refuted them are enough for
// distrusting them further; scans that say nothing are not.
TEST(OdometryMonitorTest, AFaultGoesOnWithLessEvidence) {
  for (const double later : {0.5, 2.}) {
    OdometryMonitor monitor((OdometryCheckOptions()));
    MotionComparison comparison = Slip();
    double evidence = 8.;
    comparison.evidence = [&](const Pose2&) { return evidence; };
    for (int i = 1; i <= 20; ++i) {
      comparison.time = i * kInterval;
      monitor.Add(comparison);
    }
    ASSERT_EQ(monitor.state(), OdometryState::kSlipping);
    evidence = later;
    comparison.time += kInterval;
    EXPECT_EQ(monitor.Add(comparison) == OdometryState::kSlipping, later > 1.);
  }
}

// A match that makes up for the errors of several intervals is no jump of the
// odometry in the last of them, which would be over with it.
TEST(OdometryMonitorTest, WhatMakesUpForErrorsIsNoJump) {
  for (const bool makes_up : {false, true}) {
    OdometryMonitor monitor((OdometryCheckOptions()));
    MotionComparison comparison;
    comparison.interval = kInterval;
    comparison.odometry = comparison.match = kForward;
    for (int i = 1; i <= 10; ++i) {
      comparison.time = i * kInterval;
      ASSERT_EQ(monitor.Add(comparison), OdometryState::kOk);
    }
    comparison.time += kInterval;
    comparison.match = Pose2(-0.4, 0., 0.);
    comparison.makes_up = makes_up;
    const OdometryState state = monitor.Add(comparison);
    EXPECT_EQ(state == OdometryState::kJumping, !makes_up);
    EXPECT_EQ(monitor.IsTrusted(), !makes_up);
  }
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
