// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/rotation_check.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr CalibrationFilter::Noise kExact = {0.002, 0.002, 2e-4, 4.};
constexpr CalibrationFilter::Noise kRough = {0.01, 0.03, 2e-4, 4.};

// Stretches of a second of turns to and fro; the gyroscope reports
// rotation / factor + bias, the other sensor drifts by `own_drift` rad/s.
RotationCheck Turned(const CalibrationFilter::Noise& noise, const bool drifts,
                     const double factor, const double bias,
                     const double own_drift, const int num_stretches = 40) {
  RotationCheck check(noise, drifts);
  for (int i = 0; i < num_stretches; ++i) {
    const double angle = 0.4 * std::sin(0.7 * i);
    check.Add(1., angle / factor + bias, angle + own_drift, 0., false);
  }
  return check;
}

TEST(RotationCheckTest, LearnsFactorAndDrift) {
  const RotationCheck check = Turned(kExact, false, 1.05, 0.02, 0.);
  EXPECT_EQ(check.state(), GyroscopeState::kProven);
  EXPECT_NEAR(check.factor(), 1.05, 3. * check.factor_sigma());
  EXPECT_NEAR(check.drift(), -1.05 * 0.02, 3. * check.drift_sigma());
  EXPECT_LT(check.drift_sigma(), 0.001);
}

TEST(RotationCheckTest, UnprovenBeforeItTurns) {
  RotationCheck check(kExact, false);
  for (int i = 0; i < 20; ++i) check.Add(1., 0., 0., 0., false);
  EXPECT_EQ(check.state(), GyroscopeState::kUnproven);
}

TEST(RotationCheckTest, RefutedByAWrongFactor) {
  EXPECT_EQ(Turned(kExact, false, -1., 0., 0.).state(),
            GyroscopeState::kRefuted);
  EXPECT_EQ(Turned(kExact, false, 1.3, 0., 0.).state(),
            GyroscopeState::kRefuted);
  EXPECT_EQ(Turned(kExact, false, 1.2, 0., 0.).state(),
            GyroscopeState::kProven);
}

TEST(RotationCheckTest, RefutedByContradictions) {
  RotationCheck check = Turned(kExact, false, 1., 0., 0.);
  ASSERT_EQ(check.state(), GyroscopeState::kProven);
  for (int i = 0; i < 40; ++i) check.Add(1., 0., i % 2 - 0.5, 0., false);
  EXPECT_EQ(check.state(), GyroscopeState::kRefuted);
}

// The drift of wheels is not taken for the bias of the gyroscope; standstill
// tells that.
TEST(RotationCheckTest, OnlyStandstillTellsTheBiasBesideASensorThatDrifts) {
  RotationCheck check = Turned(kRough, true, 1., 0.01, 0.02);
  EXPECT_EQ(check.state(), GyroscopeState::kProven);
  EXPECT_EQ(check.drift(), 0.);
  for (int i = 0; i < 10; ++i) check.Add(1., 0.01, 0., 0., true);
  EXPECT_NEAR(check.drift(), -0.01, 1e-3);
  EXPECT_LT(check.drift_sigma(), 0.005);
  // A sensor that does not drift is believed at once.
  EXPECT_NEAR(Turned(kExact, false, 1., 0.01, 0.02).drift(), 0.01, 1e-3);
}

TEST(RotationCheckTest, TheBiasMayBeGiven) {
  RotationCheck check(kExact, false);
  check.SetBias(0.03, 0.001);
  EXPECT_EQ(check.drift(), -0.03);
  EXPECT_NEAR(check.drift_sigma(), 0.001, 3e-5);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
