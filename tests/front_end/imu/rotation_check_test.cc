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

// Of a second.
RotationCheck::Stretch Stretch(const double measured, const double angle) {
  RotationCheck::Stretch stretch;
  stretch.seconds = 1.;
  stretch.measured = measured;
  stretch.angle = angle;
  return stretch;
}

// Stretches of a second of turns to and fro; the gyroscope reports
// rotation / factor + bias, the other sensor drifts by `own_drift` rad/s.
RotationCheck Turned(const CalibrationFilter::Noise& noise, const bool drifts,
                     const double factor, const double bias,
                     const double own_drift, const int num_stretches = 40) {
  RotationCheck check(noise, drifts);
  for (int i = 0; i < num_stretches; ++i) {
    const double angle = 0.4 * std::sin(0.7 * i);
    check.Add(Stretch(angle / factor + bias, angle + own_drift));
  }
  return check;
}

TEST(RotationCheckTest, LearnsFactorAndDrift) {
  const RotationCheck check = Turned(kExact, false, 1.05, 0.02, 0.);
  EXPECT_EQ(check.state(), GyroscopeState::kProven);
  EXPECT_NEAR(check.factor(), 1.05, 3. * check.factor_sigma());
  EXPECT_NEAR(check.EstimateDrift().value, -1.05 * 0.02,
              3. * std::sqrt(check.EstimateDrift().variance));
  EXPECT_LT(std::sqrt(check.EstimateDrift().variance), 0.001);
}

TEST(RotationCheckTest, UnprovenBeforeItTurns) {
  RotationCheck check(kExact, false);
  for (int i = 0; i < 20; ++i) check.Add(Stretch(0., 0.));
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
  for (int i = 0; i < 40; ++i) check.Add(Stretch(0., i % 2 - 0.5));
  EXPECT_EQ(check.state(), GyroscopeState::kRefuted);
}

// The drift of wheels is not taken for the bias of the gyroscope; standstill
// tells that.
TEST(RotationCheckTest, OnlyStandstillTellsTheBiasBesideASensorThatDrifts) {
  RotationCheck check = Turned(kRough, true, 1., 0.01, 0.02);
  EXPECT_EQ(check.state(), GyroscopeState::kProven);
  EXPECT_EQ(check.EstimateDrift().value, 0.);
  RotationCheck::Stretch rest = Stretch(0.01, 0.);
  rest.is_at_rest = true;
  for (int i = 0; i < 10; ++i) check.Add(rest);
  EXPECT_NEAR(check.EstimateDrift().value, -0.01, 1e-3);
  EXPECT_LT(std::sqrt(check.EstimateDrift().variance), 0.005);
  // A sensor that does not drift is believed at once.
  EXPECT_NEAR(Turned(kExact, false, 1., 0.01, 0.02).EstimateDrift().value, 0.01,
              1e-3);
}

// An error that stays is not averaged away.
TEST(RotationCheckTest, ErrorsThatStayWiden) {
  double sigma[3];
  for (int k = 0; k < 3; ++k) {
    RotationCheck check(kExact, false);
    for (int i = 0; i < 100; ++i) {
      RotationCheck::Stretch stretch = Stretch(0., 0.);
      if (k == 1) stretch.sigma = 0.01;
      if (k == 2) stretch.walk = 0.01;
      check.Add(stretch);
    }
    sigma[k] = std::sqrt(check.EstimateDrift().variance);
  }
  EXPECT_LT(sigma[0], sigma[1]);
  EXPECT_LT(1.5 * sigma[1], sigma[2]);
}

TEST(RotationCheckTest, TheBiasMayBeGiven) {
  RotationCheck check(kExact, false);
  check.SetBias(0.03, 0.001);
  EXPECT_NEAR(check.EstimateDrift().value, -0.03, 1e-4);
  EXPECT_NEAR(std::sqrt(check.EstimateDrift().variance), 0.001, 3e-5);
}

// Most gyroscopes have small biases; a few have large ones, which are believed
// once they are measured well.
TEST(RotationCheckTest, SmallBiasesAreLikelier) {
  RotationCheck check(kExact, false);
  EXPECT_EQ(check.EstimateDrift().value, 0.);
  EXPECT_NEAR(check.EstimateDrift().variance, 0.9 * 2.5e-5 + 0.1 * 2.5e-3,
              5e-5);
  // As likely a priori as by the measurement.
  check.SetBias(0.005, std::sqrt(2.5e-5 - 4e-8));
  const RotationCheck::Drift small = check.EstimateDrift();
  EXPECT_NEAR(small.value, -0.0025, 3e-4);
  EXPECT_NEAR(std::sqrt(small.variance), 0.005 / std::sqrt(2.), 3e-4);
  check.SetBias(0.04, std::sqrt(2.5e-5 - 4e-8));
  EXPECT_NEAR(check.EstimateDrift().value, -0.04, 1e-3);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
