// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/dead_reckoning.h"

#include <cmath>
#include <memory>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

constexpr double kStep = 0.05;  // seconds between readings of odometry

// Half a metre a second; turns to and fro, 0.5 rad/s for 2 s every 10 s.
double Rate(const double time) {
  const double phase = std::fmod(time, 20.);
  if (phase >= 5. && phase < 7.) return 0.5;
  if (phase >= 15. && phase < 17.) return -0.5;
  return 0.;
}

class DeadReckoningTest : public testing::Test {
 protected:
  DeadReckoningTest()
      : odometry_(OdometryNoiseOptions(), TimeOffsetOptions(),
                  OdometryCalibrationOptions()),
        gyroscope_(GyroscopeOptions()),
        reckoning_(OdometryNoiseOptions()) {}

  // Wheels whose heading drifts by `drift` rad/s.
  void Drive(const double seconds, const double drift,
             const bool has_gyroscope = true) {
    const double end = time_ + seconds;
    while (time_ < end - 0.5 * kStep) {
      for (int k = 0; k < 5; ++k) {
        const double middle = time_ + 0.01 * k + 0.005;
        true_ = true_ * Pose2(0., 0., 0.005 * Rate(middle)) *
                Pose2(0.005, 0., 0.) * Pose2(0., 0., 0.005 * Rate(middle));
        wheels_ = wheels_ * Pose2(0., 0., 0.005 * (Rate(middle) + drift)) *
                  Pose2(0.005, 0., 0.) *
                  Pose2(0., 0., 0.005 * (Rate(middle) + drift));
        if (has_gyroscope) gyroscope_.Add(middle + 0.005, Rate(middle));
      }
      time_ += kStep;
      ASSERT_TRUE(odometry_.Add(time_, wheels_));
      reckoning_.Add(time_, wheels_);
      reckoning_.Advance(odometry_, &gyroscope_);
    }
  }
  bool Predict(const double from, const double to,
               OdometryMotion* const motion) const {
    return reckoning_.Predict(from, to, odometry_, gyroscope_, motion);
  }

  OdometryPredictor odometry_;
  Gyroscope gyroscope_;
  DeadReckoning reckoning_;
  double time_ = 0.;
  Pose2 true_, wheels_;
};

// A minute with wheels that turn by 1.2 radians too much. Nothing proved the
// gyroscope before.
TEST_F(DeadReckoningTest, TheHeadingOfAGapIsThatOfTheGyroscope) {
  Drive(2., 0.02);
  const Pose2 true_start = true_;
  const Pose2 wheels_start = wheels_;
  const double start = time_;
  Drive(60., 0.02);
  OdometryMotion motion;
  ASSERT_TRUE(Predict(start, time_, &motion));
  const Pose2 expected = Between(true_start, true_);
  const Pose2 by_wheels = Between(wheels_start, wheels_);
  ASSERT_GT((by_wheels.translation() - expected.translation()).norm(), 5.);
  EXPECT_LT((motion.motion.translation() - expected.translation()).norm(), 0.2);
  EXPECT_NEAR(motion.motion.theta, expected.theta, 0.02);
  // Of a distance of some 29 m: a tenth along, and half of it times the
  // heading's error across.
  const double distance = motion.motion.translation().norm();
  const double rotation =
      gyroscope_.Correction().Variance(motion.motion.theta, 60.);
  EXPECT_NEAR(motion.covariance(2, 2), rotation, 1e-12);
  const double along = 0.01 + 0.1 * distance;
  const double scale = odometry_.calibration().translation_scale_sigma();
  const double position = motion.covariance.topLeftCorner(2, 2).trace();
  EXPECT_NEAR(position,
              2. * along * along + 0.25 * distance * distance * rotation +
                  2. * scale * scale * distance * distance,
              1e-9);
}

// The ends lie within steps.
TEST_F(DeadReckoningTest, StepsAreDivided) {
  Drive(40., 0.);
  OdometryMotion whole, first, second;
  ASSERT_TRUE(Predict(20.012, 30.03, &whole));
  ASSERT_TRUE(Predict(20.012, 25.671, &first));
  ASSERT_TRUE(Predict(25.671, 30.03, &second));
  const Pose2 off = Between(first.motion * second.motion, whole.motion);
  EXPECT_LT(off.translation().norm(), 5e-4);
  EXPECT_NEAR(off.theta, 0., 1e-6);
  OdometryMotion step;
  ASSERT_TRUE(Predict(20.01, 20.02, &step));
  EXPECT_NEAR(step.motion.x, 0.005, 1e-6);
}

// The next reading of odometry, a tenth of a second later, is not there yet.
TEST_F(DeadReckoningTest, TheEndIsExtrapolatedLikeOdometry) {
  Drive(40., 0.);
  OdometryMotion motion;
  ASSERT_TRUE(Predict(38., time_ + 0.1, &motion));
  EXPECT_NEAR(motion.motion.x, 1.05, 1e-3);
  EXPECT_NEAR(motion.motion.theta, 0., 1e-3);
  EXPECT_FALSE(Predict(30., time_ + 1., &motion));
}

TEST_F(DeadReckoningTest, WithoutAGyroscopeThereIsNone) {
  OdometryMotion motion;
  EXPECT_FALSE(Predict(0., 1., &motion));
  Drive(40., 0., false);
  EXPECT_FALSE(Predict(20., 30., &motion));
  // The gyroscope appears: not for what was before.
  Drive(40., 0.);
  EXPECT_FALSE(Predict(30., 50., &motion));
  EXPECT_TRUE(Predict(50., 70., &motion));
  // It is gone again for a while.
  Drive(10., 0., false);
  Drive(10., 0.);
  EXPECT_FALSE(Predict(70., 95., &motion));
  EXPECT_TRUE(Predict(91., 99., &motion));
}

TEST_F(DeadReckoningTest, AnUnprovenGyroscopeIsNotUsed) {
  Drive(4.5, 0.);
  OdometryMotion motion;
  EXPECT_FALSE(Predict(1., 4., &motion));
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
