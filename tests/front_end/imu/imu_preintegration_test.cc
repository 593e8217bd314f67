// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/imu/imu_preintegration.h"

#include <cmath>
#include <limits>

#include "Eigen/Geometry"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

PlanarImuReading Reading(const double time, const double ax, const double ay,
                         const double yaw_rate) {
  PlanarImuReading reading;
  reading.time = time;
  reading.acceleration = Eigen::Vector2d(ax, ay);
  reading.yaw_rate = yaw_rate;
  return reading;
}

TEST(ImuPreintegrationTest, ConstantAccelerationByHand) {
  ImuBias bias;
  bias.acceleration = Eigen::Vector2d(0.5, 0.);
  ImuPreintegrator integrator(ImuNoiseOptions(), bias);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(integrator.Add(Reading(0.1 * i, 2.5, 0., 0.),
                               Reading(0.1 * (i + 1), 2.5, 0., 0.)));
  }
  // a = 2 for one second: alpha = 1 m, beta = 2 m/s.
  EXPECT_NEAR(integrator.result().duration, 1., 1e-12);
  EXPECT_NEAR(integrator.result().alpha.x(), 1., 1e-12);
  EXPECT_NEAR(integrator.result().beta.x(), 2., 1e-12);
  EXPECT_EQ(integrator.result().gamma, 0.);
}

TEST(ImuPreintegrationTest, MidpointOfEquationThirteen) {
  // One step with rate 0 -> 1 rad/s over 1 s: mean rate 0.5, heading 0.5; the
  // second acceleration (1, 0) is turned by 0.5 rad.
  ImuPreintegrator integrator((ImuNoiseOptions()), ImuBias());
  integrator.Add(Reading(0., 1., 0., 0.), Reading(1., 1., 0., 1.));
  const double ax = 0.5 * (1. + std::cos(0.5)), ay = 0.5 * std::sin(0.5);
  EXPECT_NEAR(integrator.result().gamma, 0.5, 1e-15);
  EXPECT_NEAR(integrator.result().beta.x(), ax, 1e-15);
  EXPECT_NEAR(integrator.result().beta.y(), ay, 1e-15);
  EXPECT_NEAR(integrator.result().alpha.x(), 0.5 * ax, 1e-15);
}

TEST(ImuPreintegrationTest, CircleReturnsToTheTruth) {
  // Speed 1 m/s, rate 0.5 rad/s: centripetal acceleration 0.5 m/s^2 to the
  // left.
  const double rate = 0.5, speed = 1.;
  ImuPreintegrator integrator((ImuNoiseOptions()), ImuBias());
  const int steps = 2000;
  const double dt = 2. / steps;
  for (int i = 0; i < steps; ++i) {
    integrator.Add(Reading(i * dt, 0., rate * speed, rate),
                   Reading((i + 1) * dt, 0., rate * speed, rate));
  }
  PlanarState state;
  state.velocity = Eigen::Vector2d(speed, 0.);
  const PlanarState next = Predict(state, integrator.result());
  const double radius = speed / rate;
  EXPECT_NEAR(next.pose.x, radius * std::sin(1.), 1e-6);
  EXPECT_NEAR(next.pose.y, radius * (1. - std::cos(1.)), 1e-6);
  EXPECT_NEAR(next.pose.theta, 1., 1e-9);
  EXPECT_NEAR(next.velocity.norm(), speed, 1e-6);
}

TEST(ImuPreintegrationTest, PredictionUsesVelocityTimesTime) {
  PreintegratedImu imu;
  imu.duration = 2.;
  PlanarState state;
  state.pose = Pose2(1., 1., M_PI / 2.);
  state.velocity = Eigen::Vector2d(0., 3.);
  imu.alpha = Eigen::Vector2d(1., 0.);  // forward, that is along +y
  const PlanarState next = Predict(state, imu);
  EXPECT_NEAR(next.pose.x, 1., 1e-12);
  EXPECT_NEAR(next.pose.y, 1. + 6. + 1., 1e-12);
}

TEST(ImuPreintegrationTest, CovarianceIsThatOfSampledNoise) {
  ImuNoiseOptions noise;
  noise.acceleration_density = 0.1;
  noise.yaw_rate_density = 0.05;
  const double dt = 0.01;
  const int steps = 100, trials = 3000;
  Random random(4);
  Matrix5d sum = Matrix5d::Zero();
  ImuPreintegrator exact(noise, ImuBias());
  for (int i = 0; i < steps; ++i) {
    exact.Add(Reading(i * dt, 0.8, 0.2, 0.3),
              Reading((i + 1) * dt, 0.8, 0.2, 0.3));
  }
  Eigen::Matrix<double, 5, 1> truth;
  truth << exact.result().alpha, exact.result().beta, exact.result().gamma;
  for (int t = 0; t < trials; ++t) {
    ImuPreintegrator sampled(noise, ImuBias());
    for (int i = 0; i < steps; ++i) {
      const double ax = 0.8 + random.Normal(0., 0.1 / std::sqrt(dt));
      const double ay = 0.2 + random.Normal(0., 0.1 / std::sqrt(dt));
      const double w = 0.3 + random.Normal(0., 0.05 / std::sqrt(dt));
      sampled.Add(Reading(i * dt, ax, ay, w), Reading((i + 1) * dt, ax, ay, w));
    }
    Eigen::Matrix<double, 5, 1> error;
    error << sampled.result().alpha, sampled.result().beta,
        sampled.result().gamma;
    error -= truth;
    sum += error * error.transpose();
  }
  const Matrix5d sampled_covariance = sum / trials;
  const Matrix5d& predicted = exact.result().covariance;
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(sampled_covariance(i, i) / predicted(i, i), 1., 0.1) << i;
  }
  // Yaw noise of density s over one second: variance s^2.
  EXPECT_NEAR(predicted(4, 4), 0.05 * 0.05, 1e-12);
}

TEST(ImuPreintegrationTest, BadIntervalsAreIgnored) {
  ImuPreintegrator integrator((ImuNoiseOptions()), ImuBias());
  EXPECT_FALSE(
      integrator.Add(Reading(1., 0., 0., 0.), Reading(1., 0., 0., 0.)));
  EXPECT_FALSE(
      integrator.Add(Reading(2., 0., 0., 0.), Reading(1., 0., 0., 0.)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
      integrator.Add(Reading(0., nan, 0., 0.), Reading(1., 0., 0., 0.)));
  EXPECT_EQ(integrator.result().duration, 0.);
  EXPECT_TRUE(integrator.result().covariance.isZero(0.));
}

TEST(ImuPreintegrationTest, InterpolatesReadings) {
  const PlanarImuReading middle =
      InterpolateReading(Reading(1., 0., 2., 0.), Reading(3., 4., 2., 1.), 1.5);
  EXPECT_NEAR(middle.acceleration.x(), 1., 1e-15);
  EXPECT_NEAR(middle.yaw_rate, 0.25, 1e-15);
  EXPECT_EQ(
      InterpolateReading(Reading(1., 1., 0., 0.), Reading(1., 3., 0., 0.), 1.)
          .acceleration.x(),
      1.);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
