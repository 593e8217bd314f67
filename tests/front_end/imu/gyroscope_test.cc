// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/gyroscope.h"

#include <algorithm>
#include <cmath>

#include "cartographer_ext/common/pose2.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

// Drives straight on, turns by 90 degrees at 0.5 rad/s to alternating sides.
double Rate(const double time) {
  const double phase = std::fmod(time, 20.);
  if (phase >= 5. && phase < 5. + kPi) return 0.5;
  if (phase >= 15. && phase < 15. + kPi) return -0.5;
  return 0.;
}

double Heading(const double time) {
  const double phase = std::fmod(time, 20.);
  const auto turned = [](const double t) {
    return 0.5 * std::min(kPi, std::max(0., t));
  };
  return turned(phase - 5.) - turned(phase - 15.);
}

struct Sensor {
  double factor = 1.;  // of what it reports
  double bias = 0.;    // rad/s
  double delay = 0.;   // of its stamps, seconds
};

// A gyroscope after `seconds` of matches, exact but for 1 mrad to and fro.
Gyroscope Driven(const Sensor& sensor, const double seconds) {
  Gyroscope gyroscope((GyroscopeOptions()));
  int scan = 0;
  for (int i = 0; 0.01 * i <= seconds; ++i) {
    const double time = 0.01 * i;
    gyroscope.Add(time + sensor.delay,
                  sensor.factor * Rate(time) + sensor.bias);
    if (i < 50 || i % 10 != 0) continue;
    ++scan;
    const double noise = scan % 2 == 0 ? 0.001 : -0.001;
    MatchedRotation matched;
    matched.from = time - 0.3;
    matched.to = time - 0.2;
    matched.angle = Heading(matched.to) - Heading(matched.from) + noise;
    matched.heading = {true, 0., 0.001};
    gyroscope.AddMatch(matched);
  }
  return gyroscope;
}

TEST(GyroscopeTest, UnprovenUntilItTurns) {
  EXPECT_EQ(Driven({}, 4.).state(), GyroscopeState::kUnproven);
  EXPECT_EQ(Driven({}, 10.).state(), GyroscopeState::kProven);
}

TEST(GyroscopeTest, LearnsFactorAndBias) {
  const Gyroscope gyroscope = Driven({1.03, 0.02, 0.}, 100.);
  ASSERT_EQ(gyroscope.state(), GyroscopeState::kProven);
  EXPECT_NEAR(gyroscope.factor(), 1. / 1.03,
              3. * gyroscope.factor_sigma() + 0.003);
  GyroscopeRotation rotation;
  // A quarter turn, during 4 s.
  ASSERT_TRUE(gyroscope.Rotation(94.9, 98.9, &rotation));
  EXPECT_NEAR(rotation.angle, Heading(98.9) - Heading(94.9), 0.01);
  EXPECT_LT(std::sqrt(rotation.variance), 0.02);
}

TEST(GyroscopeTest, LearnsTheClockOffset) {
  EXPECT_NEAR(Driven({1., 0., 0.08}, 100.).clock_offset(), -0.08, 0.011);
  EXPECT_EQ(Driven({1., 0., 0.08}, 100.).state(), GyroscopeState::kProven);
}

TEST(GyroscopeTest, UpsideDownIsRefuted) {
  EXPECT_EQ(Driven({-1., 0., 0.}, 60.).state(), GyroscopeState::kRefuted);
}

TEST(GyroscopeTest, DegreesAreNotBelieved) {
  EXPECT_NE(Driven({180. / kPi, 0., 0.}, 60.).state(), GyroscopeState::kProven);
}

TEST(GyroscopeTest, ADeadSensorIsNotBelieved) {
  EXPECT_NE(Driven({0., 0., 0.}, 60.).state(), GyroscopeState::kProven);
}

TEST(GyroscopeTest, OnlyWhereThereAreReadings) {
  const Gyroscope gyroscope = Driven({}, 20.);
  GyroscopeRotation rotation;
  EXPECT_FALSE(gyroscope.Rotation(-1., 1., &rotation));
  EXPECT_FALSE(gyroscope.Rotation(19., 21., &rotation));
  EXPECT_FALSE(gyroscope.Rotation(19., 19., &rotation));
  EXPECT_TRUE(gyroscope.Rotation(19., 20.05, &rotation));
}

TEST(GyroscopeTest, AStandstillTellsTheBias) {
  Gyroscope gyroscope((GyroscopeOptions()));
  for (int i = 0; i <= 200; ++i) gyroscope.Add(0.01 * i, 0.03);
  gyroscope.SetBias(0.03);
  GyroscopeRotation rotation;
  ASSERT_TRUE(gyroscope.Rotation(1., 2., &rotation));
  // So large a bias is unlikely, so that a trace of doubt remains
  // (rotation_check.h).
  EXPECT_NEAR(rotation.angle, 0., 1e-6);
}

// Wheels that drift by 0.5 degrees a second and, now and then, slip.
void Roll(const double seconds, const bool slips, Gyroscope* const gyroscope,
          const double factor = 1.) {
  for (int i = 1; 0.05 * i <= seconds; ++i) {
    const double time = 0.05 * i;
    for (int k = 4; k >= 0; --k) {
      gyroscope->Add(time - 0.01 * k, factor * Rate(time - 0.01 * k) + 0.005);
    }
    if (i < 20) continue;
    const bool is_slipping = slips && std::fmod(time, 30.) > 28.;
    const double wheels = Heading(time) - Heading(time - 0.05) + 0.0005 +
                          (is_slipping ? 0.03 : 0.);
    gyroscope->AddWheels(time - 0.05, time, wheels);
  }
}

// Matches follow a prediction that turns by 0.02 rad/s too much, the scans do not.
TEST(GyroscopeTest, TheScanAloneIsItsEvidence) {
  Gyroscope gyroscope((GyroscopeOptions()));
  for (int i = 0; i <= 6000; ++i) {
    const double time = 0.01 * i;
    gyroscope.Add(time, Rate(time));
    if (i < 50 || i % 10 != 0) continue;
    MatchedRotation matched;
    matched.from = time - 0.3;
    matched.to = time - 0.2;
    matched.angle = Heading(matched.to) - Heading(matched.from) + 0.002;
    matched.heading = {true, -0.002 * (i / 10 - 4), 0.001};
    gyroscope.AddMatch(matched);
  }
  ASSERT_EQ(gyroscope.state(), GyroscopeState::kProven);
  EXPECT_NEAR(gyroscope.Correction().Angle(0., 10.), 0., 0.01);
}

TEST(GyroscopeTest, AScanThatHardlyTellsTheHeadingIsNone) {
  for (const double sigma : {0.001, 0.02}) {
    Gyroscope gyroscope((GyroscopeOptions()));
    for (int i = 0; i <= 3000; ++i) {
      const double time = 0.01 * i;
      gyroscope.Add(time, Rate(time));
      if (i < 50 || i % 10 != 0) continue;
      const double from = time - 0.3, to = time - 0.2;
      gyroscope.AddMatch(
          {from, to, Heading(to) - Heading(from), {true, 0., sigma}});
    }
    EXPECT_EQ(gyroscope.state(), sigma < 0.01 ? GyroscopeState::kProven
                                              : GyroscopeState::kUnproven);
  }
}

// Scans that turn to and fro, as in a hall that looks the same all round.
TEST(GyroscopeTest, WheelsThatAgreeWithItOverruleContradictions) {
  for (const bool has_wheels : {false, true}) {
    Gyroscope gyroscope((GyroscopeOptions()));
    for (int i = 0; i <= 6000; ++i) {
      const double time = 0.01 * i;
      gyroscope.Add(time, Rate(time));
      if (i < 50) continue;
      if (has_wheels && i % 5 == 0) {
        gyroscope.AddWheels(time - 0.05, time,
                            Heading(time) - Heading(time - 0.05));
      }
      if (i % 50 != 0) continue;
      const bool is_straight = Rate(time - 0.2) == 0. && Rate(time - 0.5) == 0.;
      gyroscope.AddMatch({time - 0.5,
                          time - 0.2,
                          i % 100 == 0 ? 0.3 : -0.3,
                          {is_straight, 0., 0.}});
    }
    EXPECT_EQ(gyroscope.state(),
              has_wheels ? GyroscopeState::kProven : GyroscopeState::kRefuted);
  }
}

TEST(GyroscopeTest, WheelsProveItWhereThereAreNoScans) {
  Gyroscope gyroscope((GyroscopeOptions()));
  Roll(4., false, &gyroscope);
  EXPECT_EQ(gyroscope.state(), GyroscopeState::kUnproven);
  Gyroscope other((GyroscopeOptions()));
  Roll(100., true, &other);
  ASSERT_EQ(other.state(), GyroscopeState::kProven);
  GyroscopeRotation rotation;
  ASSERT_TRUE(other.Rotation(94.9, 98.9, &rotation));
  // The bias is not known without standstill.
  EXPECT_NEAR(rotation.angle, Heading(98.9) - Heading(94.9) + 0.02, 0.006);
  double raw;
  ASSERT_TRUE(other.Raw(94.9, 98.9, &raw));
  EXPECT_NEAR(rotation.angle, other.Correction().Angle(raw, 4.), 1e-12);
  const GyroscopeCorrection correction = other.Correction();
  EXPECT_NEAR(rotation.variance, correction.Variance(raw, 4.), 1e-12);
  EXPECT_LT(correction.Variance(0., 4.), correction.Variance(1., 4.));
  EXPECT_LT(correction.Variance(1., 4.), correction.Variance(1., 8.));
}

TEST(GyroscopeTest, WheelsDoNotRefuteIt) {
  Gyroscope gyroscope((GyroscopeOptions()));
  Roll(100., false, &gyroscope, -1.);
  EXPECT_EQ(gyroscope.state(), GyroscopeState::kUnproven);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
