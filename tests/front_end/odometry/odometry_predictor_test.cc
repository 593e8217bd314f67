// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_predictor.h"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

TimeOffsetOptions Fixed(const double offset) {
  TimeOffsetOptions options;
  options.estimate = false;
  options.initial = offset;
  return options;
}

OdometryCalibrationOptions NoCalibration() {
  OdometryCalibrationOptions options;
  options.estimate_odometry_scale = false;
  options.estimate_rotation = false;
  return options;
}

// A circle of radius 1 m at 0.5 rad/s.
Pose2 OnCircle(const double t) {
  return Pose2(std::sin(0.5 * t), 1. - std::cos(0.5 * t), 0.5 * t);
}

TEST(OdometryPredictorTest, TheMotionBetweenTheScansItself) {
  OdometryPredictor predictor(OdometryNoiseOptions(), Fixed(0.),
                              NoCalibration());
  for (int i = 0; i <= 100; ++i) predictor.Add(0.05 * i, OnCircle(0.05 * i));
  OdometryMotion motion;
  ASSERT_TRUE(predictor.Predict(1., 4., &motion));
  const Pose2 expected = Between(OnCircle(1.), OnCircle(4.));
  EXPECT_NEAR(motion.motion.x, expected.x, 1e-9);
  EXPECT_NEAR(motion.motion.y, expected.y, 1e-9);
  EXPECT_NEAR(motion.motion.theta, 1.5, 1e-9);
}

TEST(OdometryPredictorTest, TheClockOffsetShiftsBothEnds) {
  OdometryPredictor predictor(OdometryNoiseOptions(), Fixed(0.1),
                              NoCalibration());
  // IsStationary until t = 1, then turns at 1 rad/s.
  for (int i = 0; i <= 60; ++i) {
    const double t = 0.05 * i;
    predictor.Add(t, Pose2(0., 0., std::max(0., t - 1.)));
  }
  OdometryMotion motion;
  ASSERT_TRUE(predictor.Predict(1., 1.2, &motion));
  EXPECT_NEAR(motion.motion.theta, 0.1, 1e-9);
}

TEST(OdometryPredictorTest, CovarianceByHand) {
  OdometryNoiseOptions noise;
  noise.translation = 0.01;
  noise.translation_per_metre = 0.1;
  noise.rotation = 0.02;
  noise.rotation_per_radian = 0.2;
  noise.rotation_per_metre = 0.05;
  // Translation 1 m along x, rotation 0.5 rad: along 0.11 m, rotation 0.02 +
  // 0.1 + 0.05.
  const Eigen::Matrix3d covariance =
      OdometryCovariance(noise, Pose2(1., 0., -0.5));
  EXPECT_NEAR(covariance(0, 0), 0.11 * 0.11, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.11 * 0.11 + 0.085 * 0.085, 1e-12);
  EXPECT_NEAR(covariance(2, 2), 0.17 * 0.17, 1e-12);
  EXPECT_NEAR(covariance(0, 1), 0., 1e-12);
  // The same translation along y.
  const Eigen::Matrix3d turned = OdometryCovariance(noise, Pose2(0., 1., -0.5));
  EXPECT_NEAR(turned(0, 0), covariance(1, 1), 1e-12);
  EXPECT_NEAR(turned(1, 1), covariance(0, 0), 1e-12);
}

TEST(OdometryPredictorTest, TheCalibrationHasItsShare) {
  OdometryCalibrationOptions calibration;
  calibration.translation_scale = 1.02;
  calibration.translation_scale_sigma = 0.5;
  calibration.estimate_rotation = false;
  OdometryPredictor predictor(OdometryNoiseOptions(), Fixed(0.), calibration);
  predictor.Add(0., Pose2());
  predictor.Add(1., Pose2(1., 0., 0.));
  OdometryMotion motion;
  ASSERT_TRUE(predictor.Predict(0., 1., &motion));
  EXPECT_EQ(motion.raw.x, 1.);
  EXPECT_EQ(motion.motion.x, 1.02);
  // 0.01 m and 0.1 per metre; the scale, of the uncorrected translation.
  EXPECT_NEAR(motion.covariance(0, 0), 0.112 * 0.112 + 0.25, 1e-12);
}

TEST(OdometryPredictorTest, NoPredictionWithoutReadingsAround) {
  OdometryNoiseOptions noise;
  noise.max_extrapolation = 0.3;
  OdometryPredictor predictor(noise, Fixed(0.), NoCalibration());
  OdometryMotion motion;
  EXPECT_FALSE(predictor.Predict(0., 1., &motion));
  predictor.Add(1., Pose2());
  predictor.Add(1.1, Pose2(0.1, 0., 0.));
  EXPECT_FALSE(predictor.Predict(0., 1.1, &motion));
  EXPECT_FALSE(predictor.Predict(1., 1.5, &motion));
  EXPECT_TRUE(predictor.Predict(1., 1.3, &motion));
  EXPECT_NEAR(motion.motion.x, 0.3, 1e-9);
}

TEST(OdometryPredictorTest, AGapInTheScansIsBridged) {
  OdometryPredictor predictor(OdometryNoiseOptions(), Fixed(0.),
                              NoCalibration());
  for (int i = 0; i <= 100; ++i) predictor.Add(0.1 * i, OnCircle(0.1 * i));
  OdometryMotion motion;
  ASSERT_TRUE(predictor.Predict(2., 8., &motion));
  EXPECT_NEAR(motion.motion.theta, 3., 1e-9);
}

// Over metres step by step, in the frame of the start: a heading that is uncertain
// moves the end across the line to it.
TEST(OdometryPredictorTest, AGapIsReckonedStepByStep) {
  OdometryCalibrationOptions calibration;
  calibration.rotation_per_metre = 0.1;
  OdometryPredictor predictor(OdometryNoiseOptions(), Fixed(0.), calibration);
  for (int i = 0; i <= 100; ++i) {
    predictor.Add(0.1 * i, Pose2(0., 0.1 * i, 0.5 * kPi));
  }
  OdometryMotion motion;
  ASSERT_TRUE(predictor.Predict(0., 10., &motion));
  predictor.Reckon(0., 10., 0., &motion);
  EXPECT_TRUE(motion.is_reckoned);
  EXPECT_NEAR(motion.motion.x, 10. * std::sin(1.), 0.01);
  EXPECT_NEAR(motion.motion.y, 10. * (1. - std::cos(1.)), 0.01);
  EXPECT_NEAR(motion.motion.theta, 1., 1e-9);
  const Eigen::Vector2d line = motion.motion.translation().normalized();
  const Eigen::Vector2d across(-line.y(), line.x());
  const Eigen::Matrix2d position = motion.covariance.topLeftCorner<2, 2>();
  EXPECT_GT(across.dot(position * across), 4. * line.dot(position * line));

  // Not between two scans, ...
  ASSERT_TRUE(predictor.Predict(0., 2., &motion));
  const OdometryMotion before = motion;
  predictor.Reckon(0., 2., 0., &motion);
  EXPECT_FALSE(motion.is_reckoned);
  EXPECT_EQ(motion.motion.x, before.motion.x);
  EXPECT_EQ(motion.covariance, before.covariance);
  // ... nor where readings are still missing.
  motion.is_late = true;
  predictor.Reckon(0., 10., 0., &motion);
  EXPECT_FALSE(motion.is_reckoned);
}

TEST(OdometryPredictorTest, LearnsTheOffsetFromMatches) {
  OdometryPredictor predictor(OdometryNoiseOptions(), TimeOffsetOptions(),
                              NoCalibration());
  const double offset = 0.12;
  const auto heading = [](const double t) { return 0.6 * std::sin(2. * t); };
  double next_odometry = 0.;
  for (int i = 1; i <= 600; ++i) {
    const double from = 0.1 * (i - 1), to = 0.1 * i;
    while (next_odometry <= to) {
      predictor.Add(next_odometry, Pose2(0., 0., heading(next_odometry)));
      next_odometry += 0.02;
    }
    predictor.AddMatch(
        from, to, Pose2(0., 0., heading(to - offset) - heading(from - offset)));
  }
  EXPECT_NEAR(predictor.time_offset(), offset, 0.005);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
