// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/simulation/sensors/imu_model.h"

#include <cmath>
#include <vector>

#include "cartographer_ext/simulation/world_parser.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace simulation {
namespace {

ImuSettings Perfect() {
  ImuSettings settings;
  settings.present = true;
  settings.rate = 100.;
  return settings;
}

// Gyroscope and accelerometer, integrated from rest, give the whole drive back.
TEST(ImuModelTest, IntegratesBackToTruth) {
  const auto world = ParseWorld(
      "start 1 2 30\nwait 1\ngoto 5 4\ngoto 6 8\ngoto 1 9\nturn 0\nwait 1",
      "t");
  ASSERT_TRUE(world.ok()) << world.status();
  const auto drive = Drive::Plan(*world, 0);
  ASSERT_TRUE(drive.ok());
  ImuModel imu(Perfect(), 0);
  const double step = 0.01;
  Pose2 pose = world->start;
  double heading = pose.theta;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double worst = 0.;
  // Samples half-way through the steps of the drive: there the turn rate is the
  // mean of the step, and the acceleration that of the step.
  for (int64_t i = 0; (i + 1) * step < drive->duration(); ++i) {
    const io::ImuReading reading = imu.Sample(drive->At((i + 0.5) * step));
    const double turn = step * reading.angular_velocity.z();
    const double middle = heading + 0.5 * turn;
    const Eigen::Vector3d& force = reading.linear_acceleration;
    const Eigen::Vector2d acceleration(
        std::cos(middle) * force.x() - std::sin(middle) * force.y(),
        std::sin(middle) * force.x() + std::cos(middle) * force.y());
    const Eigen::Vector2d moved =
        step * velocity + 0.5 * step * step * acceleration;
    velocity += step * acceleration;
    heading += turn;
    pose.x += moved.x();
    pose.y += moved.y();
    const MotionState truth = drive->At((i + 1) * step);
    ASSERT_NEAR(heading, truth.heading, 1e-9) << i;
    worst =
        std::max(worst, (pose.translation() - truth.pose.translation()).norm());
  }
  EXPECT_LT(worst, 1e-3);
}

TEST(ImuModelTest, FeelsGravityAndTheCurve) {
  ImuModel imu(Perfect(), 0);
  MotionState motion;
  motion.speed = 0.5;
  motion.turn_rate = 0.4;
  motion.acceleration = 0.3;
  const io::ImuReading reading = imu.Sample(motion);
  EXPECT_DOUBLE_EQ(reading.linear_acceleration.x(), 0.3);
  EXPECT_DOUBLE_EQ(reading.linear_acceleration.y(), 0.2);  // v w, inwards
  EXPECT_DOUBLE_EQ(reading.linear_acceleration.z(), 9.80665);
  EXPECT_DOUBLE_EQ(reading.angular_velocity.z(), 0.4);
  EXPECT_EQ(reading.angular_velocity.x(), 0.);
}

TEST(ImuModelTest, WhiteNoiseFollowsDensityAndRate) {
  ImuSettings settings = Perfect();
  settings.gyro_noise = 1e-3;  // times sqrt(100 Hz): 0.01 rad/s
  settings.accel_noise = 5e-3;
  ImuModel imu(settings, 3);
  double gyro = 0., accel = 0., sum = 0.;
  const int kSamples = 20000;
  for (int i = 0; i != kSamples; ++i) {
    const io::ImuReading reading = imu.Sample(MotionState());
    sum += reading.angular_velocity.z();
    gyro += std::pow(reading.angular_velocity.z(), 2);
    accel += std::pow(reading.linear_acceleration.x(), 2);
  }
  EXPECT_NEAR(sum / kSamples, 0., 4e-4);
  EXPECT_NEAR(std::sqrt(gyro / kSamples), 0.01, 2e-4);
  EXPECT_NEAR(std::sqrt(accel / kSamples), 0.05, 1e-3);
}

TEST(ImuModelTest, BiasStartsRandomAndWalks) {
  ImuSettings settings = Perfect();
  settings.gyro_bias_sigma = 0.01;
  settings.gyro_bias_walk = 1e-3;
  double initial = 0., walked = 0.;
  const int kRuns = 400;
  for (int seed = 0; seed != kRuns; ++seed) {
    ImuModel imu(settings, seed);
    const double start = imu.gyro_bias().z();
    initial += start * start;
    for (int i = 0; i != 400; ++i) imu.Sample(MotionState());  // 4 s
    walked += std::pow(imu.gyro_bias().z() - start, 2);
  }
  EXPECT_NEAR(std::sqrt(initial / kRuns), 0.01, 0.0012);
  // sigma(t) = walk * sqrt(t).
  EXPECT_NEAR(std::sqrt(walked / kRuns), 2e-3, 2.4e-4);
}

}  // namespace
}  // namespace simulation
}  // namespace cartographer_ext
