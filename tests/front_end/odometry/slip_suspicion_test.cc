// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/slip_suspicion.h"

#include <vector>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kInterval = 0.1;  // seconds
constexpr bool kSeen = true;       // the scan determines the translation

// A robot that drives at 0.5 m/s, at most 1 m/s^2.
class Drive {
 public:
  // The matches follow the wheels. Whether slip is suspected.
  bool Step(const double wheels, const bool is_observable,
            const bool is_wrong = false) {
    return Step(wheels, wheels, is_observable, is_wrong);
  }
  bool Step(const double wheels, const double match, const bool is_observable,
            const bool is_wrong) {
    time_ += kInterval;
    suspicion_.Add({{kInterval, wheels, absl::nullopt}},
                   {time_, match, is_observable});
    if (!suspicion_.is_believed()) suspicion_.Learn(is_wrong);
    return suspicion_.is_suspected();
  }
  void Drives(const double speed, const bool is_observable, const int steps) {
    for (int i = 0; i < steps; ++i) Step(speed, is_observable);
  }
  // Comes up to speed as slowly as robots do.
  void Starts(const bool is_observable) {
    for (double speed = 0.; speed < 0.5; speed += 0.05) {
      Step(speed, is_observable);
    }
    Drives(0.5, is_observable, 20);
  }
  SlipSuspicion* suspicion() { return &suspicion_; }

 private:
  SlipSuspicion suspicion_{1.};
  double time_ = 0.;
};

TEST(SlipSuspicionTest, WheelsFasterThanTheRobotEverWas) {
  Drive drive;
  drive.Starts(kSeen);
  drive.Drives(0.5, !kSeen, 10);
  EXPECT_NEAR(drive.suspicion()->speed_before(), 0.5, 0.01);
  EXPECT_FALSE(drive.Step(0.8, !kSeen));
  EXPECT_TRUE(drive.Step(0.8, !kSeen));
  EXPECT_TRUE(drive.suspicion()->is_believed());
  drive.Drives(0.8, !kSeen, 10);
  EXPECT_TRUE(drive.suspicion()->is_believed());
  EXPECT_NEAR(drive.suspicion()->speed_before(), 0.5, 0.01);
  // They grip again.
  EXPECT_FALSE(drive.Step(0.5, !kSeen));
  EXPECT_FALSE(drive.suspicion()->is_believed());
}

TEST(SlipSuspicionTest, TheScanTellsAgain) {
  Drive drive;
  drive.Starts(kSeen);
  drive.Drives(0.8, !kSeen, 5);
  EXPECT_TRUE(drive.suspicion()->is_believed());
  EXPECT_FALSE(drive.Step(0.8, kSeen));
  EXPECT_FALSE(drive.suspicion()->is_believed());
  EXPECT_TRUE(drive.suspicion()->is_likely());
  // And finds for a second and a half that the wheels are right.
  drive.Drives(0.8, kSeen, 15);
  EXPECT_FALSE(drive.suspicion()->is_likely());
  EXPECT_FALSE(drive.Step(0.8, !kSeen));
}

TEST(SlipSuspicionTest, AStampThatIsLateIsMadeUpFor) {
  Drive drive;
  drive.Starts(kSeen);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(drive.Step(0.8, !kSeen));
    EXPECT_FALSE(drive.Step(0.2, !kSeen));
    for (double speed = 0.25; speed < 0.51; speed += 0.05) {
      EXPECT_FALSE(drive.Step(speed, !kSeen));
    }
  }
}

TEST(SlipSuspicionTest, OfRobotsThatStartOrStopNothingIsBelieved) {
  Drive drive;
  drive.Starts(kSeen);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(drive.Step(0., !kSeen));
  EXPECT_FALSE(drive.suspicion()->is_believed());
  Drive other;
  other.Starts(kSeen);
  for (double speed = 0.4; speed >= 0.; speed -= 0.1) other.Step(speed, kSeen);
  other.Drives(0., !kSeen, 5);
  other.Step(0.8, !kSeen);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(other.Step(0.8, !kSeen));
  EXPECT_FALSE(other.suspicion()->is_believed());
}

TEST(SlipSuspicionTest, ARobotThatWasAsFastMayBeAgain) {
  Drive drive;
  drive.Starts(kSeen);
  for (double speed = 0.5; speed < 0.9; speed += 0.05) drive.Step(speed, kSeen);
  drive.Drives(0.9, kSeen, 40);
  for (double speed = 0.9; speed > 0.5; speed -= 0.05) drive.Step(speed, kSeen);
  drive.Drives(0.5, !kSeen, 10);
  drive.Drives(0.8, !kSeen, 3);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(drive.Step(0.8, !kSeen));
  EXPECT_FALSE(drive.suspicion()->is_believed());
  // Nothing is known of a robot that no scan has measured.
  Drive unseen;
  unseen.Starts(!kSeen);
  drive.Drives(0.8, !kSeen, 5);
  EXPECT_FALSE(unseen.suspicion()->is_believed());
}

// p = (s + 1) / (s + n + 1.5).
TEST(SlipSuspicionTest, SuddenChangesThatWereNoSlipAreLearnt) {
  Drive drive;
  drive.Starts(kSeen);
  // The matches are steady.
  const auto jump = [&drive](const bool is_slip) {
    for (int i = 0; i < 20; ++i) drive.Step(0.8, 0.5, kSeen, is_slip && i > 3);
    for (double speed = 0.8; speed >= 0.5; speed -= 0.05) {
      drive.Step(speed, 0.5, kSeen, false);
    }
    drive.Drives(0.5, kSeen, 20);
  };
  const auto is_believed = [&drive] {
    drive.Drives(0.5, !kSeen, 5);
    drive.Drives(0.8, !kSeen, 5);
    const bool result = drive.suspicion()->is_believed();
    drive.Drives(0.5, !kSeen, 5);
    return result;
  };
  EXPECT_TRUE(is_believed());  // 1 of 1.5
  jump(false);
  EXPECT_FALSE(is_believed());  // 1 of 2.5
  jump(true);
  EXPECT_TRUE(is_believed());  // 2 of 3.5
  jump(false);
  EXPECT_FALSE(is_believed());  // 2 of 4.5
}

// Lidars that deliver late and then in bunches: the speed lasts for a few scans.
TEST(SlipSuspicionTest, ShortChangesThatScansHaveSeenAreNoSlip) {
  Drive drive;
  drive.Starts(kSeen);
  drive.Drives(0.5, kSeen, 10);
  drive.Drives(0.8, kSeen, 4);
  drive.Drives(0.5, kSeen, 10);
  drive.Drives(0.8, !kSeen, 10);
  EXPECT_FALSE(drive.suspicion()->is_believed());
}

TEST(SlipSuspicionTest, OverAMillisecondThereIsNoSpeed) {
  SlipSuspicion suspicion(1.);
  double time = 0.;
  for (int i = 1; i <= 100; ++i) {
    time += i % 10 == 0 ? 0.191 : 0.001;
    const double interval = i % 10 == 0 ? 0.191 : 0.001;
    // A tenth of the distance in each.
    suspicion.Add({{interval, 0.01 / interval, absl::nullopt}},
                  {time, 0.5, !kSeen});
    EXPECT_FALSE(suspicion.is_suspected()) << i;
  }
}

// What was over before scans told is neither.
TEST(SlipSuspicionTest, NothingIsLearntAfterwards) {
  Drive drive;
  drive.Starts(kSeen);
  for (int i = 0; i < 3; ++i) {
    drive.Drives(0.5, !kSeen, 5);
    drive.Drives(0.8, !kSeen, 10);
    EXPECT_TRUE(drive.suspicion()->is_believed());
    drive.Drives(0.5, kSeen, 30);
  }
}

TEST(SlipSuspicionTest, ItExpires) {
  Drive drive;
  drive.Starts(kSeen);
  drive.Step(0.8, !kSeen);
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(drive.Step(0.8, !kSeen)) << i;
  EXPECT_FALSE(drive.Step(0.8, !kSeen));
  EXPECT_FALSE(drive.suspicion()->is_believed());
}

TEST(SlipSuspicionTest, WithoutOdometryNothingIsSuspected) {
  Drive drive;
  drive.Starts(kSeen);
  drive.Drives(0.8, !kSeen, 3);
  EXPECT_TRUE(drive.suspicion()->is_believed());
  drive.suspicion()->Interrupt();
  EXPECT_FALSE(drive.suspicion()->is_believed());
  // Of the change over the gap nothing is known.
  EXPECT_FALSE(drive.Step(1.2, !kSeen));
}

TEST(SlipSuspicionTest, OverAGapNothingIsSuspected) {
  Drive drive;
  drive.Starts(kSeen);
  drive.Drives(0.8, !kSeen, 5);
  EXPECT_TRUE(drive.suspicion()->is_believed());
  drive.suspicion()->Add({{1., 0.8, absl::nullopt}}, {10., 0.8, !kSeen});
  EXPECT_FALSE(drive.suspicion()->is_believed());
  EXPECT_FALSE(drive.suspicion()->is_suspected());
}

TEST(SlipSuspicionTest, AnImuTellsWhatTheRobotDid) {
  SlipSuspicion suspicion(1.);
  suspicion.Add({{kInterval, 0.3, 0.}}, {0.1, 0.3, !kSeen});
  // Within half of what is allowed without.
  suspicion.Add({{kInterval, 0.6, 0.26}}, {0.2, 0.6, !kSeen});
  EXPECT_FALSE(suspicion.is_suspected());
  suspicion.Add({{kInterval, 0.9, 0.24}}, {0.3, 0.9, !kSeen});
  suspicion.Add({{kInterval, 0.9, 0.}}, {0.4, 0.9, !kSeen});
  EXPECT_TRUE(suspicion.is_suspected());
}

// A slow laser: the mean over its interval changes by 0.9 m/s^2 only.
TEST(SlipSuspicionTest, WheelsSlipWithinAnInterval) {
  SlipSuspicion suspicion(1.);
  const auto speeds = [](const double first, const double second) {
    return std::vector<WheelSpeed>{{kInterval, first, absl::nullopt},
                                   {kInterval, second, absl::nullopt}};
  };
  for (int i = 1; i <= 20; ++i) {
    suspicion.Add(speeds(0.5, 0.5), {0.2 * i, 0.5, kSeen});
    suspicion.Learn(false);
  }
  suspicion.Add(speeds(0.5, 0.5), {4.2, 0.5, !kSeen});
  EXPECT_FALSE(suspicion.is_suspected());
  suspicion.Add(speeds(0.5, 0.68), {4.4, 0.6, !kSeen});
  EXPECT_FALSE(suspicion.is_suspected());
  suspicion.Add(speeds(0.7, 0.7), {4.6, 0.7, !kSeen});
  suspicion.Add(speeds(0.7, 0.7), {4.8, 0.7, !kSeen});
  EXPECT_TRUE(suspicion.is_believed());
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
