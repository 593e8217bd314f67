// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/io/imu_levelling.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace io {
namespace {

constexpr double kGravity = 9.80665;

ImuReading Reading(const int i, const Eigen::Vector3d& acceleration,
                   const Eigen::Vector3d& rate) {
  ImuReading reading;
  reading.time = FromSeconds(0.01 * i);
  reading.linear_acceleration = acceleration;
  reading.angular_velocity = rate;
  return reading;
}

// The last of 200 equal readings.
ImuReading Settled(const Eigen::Vector3d& acceleration,
                   const Eigen::Vector3d& rate) {
  ImuLevelling levelling;
  ImuReading level;
  for (int i = 0; i < 200; ++i) {
    level = levelling.Level(Reading(i, acceleration, rate));
  }
  return level;
}

TEST(ImuLevellingTest, ALevelImuStaysAsItIs) {
  const ImuReading level = Settled({0., 0., kGravity}, {0.01, -0.02, 0.3});
  EXPECT_NEAR(level.linear_acceleration.z(), kGravity, 1e-9);
  EXPECT_NEAR(level.angular_velocity.z(), 0.3, 1e-9);
  EXPECT_NEAR(level.angular_velocity.x(), 0.01, 1e-9);
}

// By 10 degrees about y: the vertical axis of the robot is (sin, 0, cos) of the
// IMU.
TEST(ImuLevellingTest, ATiltedMountIsTakenOut) {
  const double tilt = 10. * M_PI / 180.;
  const Eigen::Vector3d up(std::sin(tilt), 0., std::cos(tilt));
  const ImuReading level = Settled(kGravity * up, 0.3 * up);
  EXPECT_NEAR(level.angular_velocity.z(), 0.3, 1e-9);
  EXPECT_NEAR(level.angular_velocity.head<2>().norm(), 0., 1e-9);
  EXPECT_NEAR(level.linear_acceleration.head<2>().norm(), 0., 1e-9);
}

TEST(ImuLevellingTest, UpsideDownItTurnsTheOtherWay) {
  const ImuReading level = Settled({0.1, 0., -kGravity}, {0., 0., -0.3});
  EXPECT_NEAR(level.angular_velocity.z(), 0.3, 1e-3);
  EXPECT_GT(level.linear_acceleration.z(), 0.);
  EXPECT_EQ(level.linear_acceleration.head<2>().norm(), 0.);
}

TEST(ImuLevellingTest, AccelerationOfTheRobotRemains) {
  ImuLevelling levelling;
  for (int i = 0; i < 2000; ++i) {
    levelling.Level(Reading(i, {0., 0., kGravity}, {0., 0., 0.}));
  }
  const ImuReading level =
      levelling.Level(Reading(2000, {1., 0., kGravity}, {0., 0., 0.}));
  EXPECT_NEAR(level.linear_acceleration.x(), 1., 0.02);
}

TEST(ImuLevellingTest, WithoutGravityTheRatesRemain) {
  for (const double size : {0., 1.}) {  // taken away; in units of g
    const ImuReading level = Settled({0.3, 0., size}, {0., 0., 0.3});
    EXPECT_NEAR(level.angular_velocity.z(), 0.3, 1e-12);
    EXPECT_NEAR(level.linear_acceleration.z(), kGravity, 1e-12);
    EXPECT_EQ(level.linear_acceleration.x(), 0.);
  }
}

TEST(ImuLevellingTest, ReadingsThatAreNotFiniteComeBackUnchanged) {
  ImuLevelling levelling;
  levelling.Level(Reading(0, {0., 0., kGravity}, {0., 0., 0.}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      std::isnan(levelling.Level(Reading(1, {nan, 0., 0.}, {0., 0., 0.}))
                     .linear_acceleration.x()));
  const ImuReading level =
      levelling.Level(Reading(2, {0., 0., kGravity}, {0., 0., 0.2}));
  EXPECT_NEAR(level.angular_velocity.z(), 0.2, 1e-9);
}

}  // namespace
}  // namespace io
}  // namespace cartographer_ext
