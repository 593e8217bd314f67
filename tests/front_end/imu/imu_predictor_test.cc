// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/imu_predictor.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

PlanarImuReading Reading(const double time, const double ax,
                         const double yaw_rate) {
  PlanarImuReading reading;
  reading.time = time;
  reading.acceleration = Eigen::Vector2d(ax, 0.);
  reading.yaw_rate = yaw_rate;
  return reading;
}

TEST(ImuPredictorTest, ConstantAccelerationAndTurn) {
  ImuPredictor predictor((ImuPredictorOptions()));
  for (int i = 0; i <= 100; ++i) predictor.Add(Reading(0.01 * i, 2., 0.));
  ImuMotion motion;
  ASSERT_TRUE(predictor.Predict(0.2, 0.7, Eigen::Vector2d(1., 0.), &motion));
  // 1 m/s for 0.5 s, and 2 * 0.25 / 2.
  EXPECT_NEAR(motion.motion.x, 0.75, 1e-9);
  EXPECT_NEAR(motion.motion.theta, 0., 1e-12);
  EXPECT_NEAR(motion.speed_change, 1., 1e-9);

  ImuPredictor turning((ImuPredictorOptions()));
  for (int i = 0; i <= 100; ++i) turning.Add(Reading(0.01 * i, 0., 0.4));
  // Between readings as well.
  ASSERT_TRUE(turning.Predict(0.205, 0.705, Eigen::Vector2d::Zero(), &motion));
  EXPECT_NEAR(motion.motion.theta, 0.2, 1e-9);
}

TEST(ImuPredictorTest, OnlyWhereThereAreReadings) {
  ImuPredictor predictor((ImuPredictorOptions()));
  ImuMotion motion;
  EXPECT_FALSE(predictor.Predict(0., 1., Eigen::Vector2d::Zero(), &motion));
  for (int i = 100; i <= 200; ++i) predictor.Add(Reading(0.01 * i, 0., 0.));
  EXPECT_FALSE(predictor.Predict(0.5, 1.5, Eigen::Vector2d::Zero(), &motion));
  EXPECT_FALSE(predictor.Predict(1.5, 2.5, Eigen::Vector2d::Zero(), &motion));
  EXPECT_FALSE(predictor.Predict(1.5, 1.5, Eigen::Vector2d::Zero(), &motion));
  EXPECT_TRUE(predictor.Predict(1.5, 2.05, Eigen::Vector2d::Zero(), &motion));
}

TEST(ImuPredictorTest, LearnsTheBiasWhileStandingAndOnlyThen) {
  ImuPredictorOptions options;
  options.stationary_time = 1.;
  ImuPredictor predictor(options);
  for (int i = 0; i <= 500; ++i) predictor.Add(Reading(0.01 * i, 0.3, 0.02));
  for (int i = 0; i < 5; ++i) {
    predictor.AddMatch(0.1 * i, 0.1 * (i + 1), Pose2(0.1, 0., 0.));
  }
  EXPECT_FALSE(predictor.acceleration_is_known());
  for (int i = 5; i < 20; ++i) {
    predictor.AddMatch(0.1 * i, 0.1 * (i + 1), Pose2(0.0005, 0., 0.));
  }
  ASSERT_TRUE(predictor.acceleration_is_known());
  EXPECT_NEAR(predictor.bias().yaw_rate, 0.02, 1e-9);
  EXPECT_NEAR(predictor.bias().acceleration.x(), 0.3, 1e-9);
  ImuMotion motion;
  ASSERT_TRUE(predictor.Predict(2., 3., Eigen::Vector2d::Zero(), &motion));
  // A hundredth is doubted, because a bias of 0.02 rad/s is unlikely.
  EXPECT_NEAR(motion.motion.theta, 0., 3e-4);
  EXPECT_NEAR(motion.motion.x, 0., 1e-9);
}

// As of an IMU whose horizontal axes are unknown.
TEST(ImuPredictorTest, ReadingsWithoutAccelerationTellTheTurnsAlone) {
  ImuPredictorOptions options;
  options.stationary_time = 1.;
  ImuPredictor predictor(options);
  for (int i = 0; i <= 500; ++i) predictor.Add(Reading(0.01 * i, 0., 0.02));
  for (int i = 0; i < 20; ++i) {
    predictor.AddMatch(0.1 * i, 0.1 * (i + 1), Pose2());
  }
  EXPECT_FALSE(predictor.acceleration_is_known());
  EXPECT_NEAR(predictor.bias().yaw_rate, 0.02, 1e-9);
  predictor.Add(Reading(5.01, 0.1, 0.02));
  EXPECT_TRUE(predictor.acceleration_is_known());
}

// The robot starts to move within an interval that still looks stationary.
TEST(ImuPredictorTest, SettingOffIsNoBias) {
  ImuPredictorOptions options;
  options.stationary_time = 1.;
  ImuPredictor predictor(options);
  for (int i = 0; i <= 300; ++i) {
    predictor.Add(Reading(0.01 * i, 0.1, i < 155 ? 0.02 : 0.3));
  }
  for (int i = 0; i < 16; ++i) {
    predictor.AddMatch(0.1 * i, 0.1 * (i + 1), Pose2());
  }
  predictor.AddMatch(1.6, 1.7, Pose2(0., 0., 0.03));
  ASSERT_TRUE(predictor.acceleration_is_known());
  EXPECT_NEAR(predictor.bias().yaw_rate, 0.02, 1e-9);
}

TEST(ImuPredictorTest, UncertaintyGrowsWithTime) {
  ImuPredictor predictor((ImuPredictorOptions()));
  for (int i = 0; i <= 300; ++i) predictor.Add(Reading(0.01 * i, 0., 0.));
  ImuMotion shorter, longer;
  ASSERT_TRUE(predictor.Predict(0., 0.5, Eigen::Vector2d::Zero(), &shorter));
  ASSERT_TRUE(predictor.Predict(0., 2., Eigen::Vector2d::Zero(), &longer));
  EXPECT_GT(longer.covariance(0, 0), shorter.covariance(0, 0));
  EXPECT_GT(longer.covariance(2, 2), shorter.covariance(2, 2));
  EXPECT_GT(shorter.covariance(2, 2), 0.);
}

TEST(ImuPredictorTest, IgnoresLateAndBrokenReadings) {
  ImuPredictor predictor((ImuPredictorOptions()));
  for (int i = 0; i <= 100; ++i) {
    predictor.Add(Reading(0.01 * i, 0., 0.1));
    predictor.Add(Reading(0.01 * i - 0.005, 0., 100.));
    predictor.Add(Reading(0.01 * i + 0.001,
                          std::numeric_limits<double>::quiet_NaN(), 0.));
  }
  ImuMotion motion;
  ASSERT_TRUE(predictor.Predict(0., 1., Eigen::Vector2d::Zero(), &motion));
  EXPECT_NEAR(motion.motion.theta, 0.1, 1e-9);
}

TEST(ImuPredictorTest, SwitchedOffItPredictsNothing) {
  ImuPredictorOptions options;
  options.enabled = false;
  ImuPredictor predictor(options);
  for (int i = 0; i <= 100; ++i) predictor.Add(Reading(0.01 * i, 0., 0.1));
  ImuMotion motion;
  EXPECT_FALSE(predictor.Predict(0., 1., Eigen::Vector2d::Zero(), &motion));
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
