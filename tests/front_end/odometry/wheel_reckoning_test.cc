// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/wheel_reckoning.h"

#include <cmath>
#include <vector>

#include "Eigen/Core"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

OdometryCalibration Calibrated(const double heading) {
  OdometryCalibrationOptions options;
  options.rotation_per_metre = heading;
  return OdometryCalibration(options);
}

// Known exactly, so that only wheels err.
OdometryCalibration Exact() {
  OdometryCalibrationOptions options;
  options.estimate_odometry_scale = options.estimate_rotation = false;
  return OdometryCalibration(options);
}

// Ten metres straight on by the wheels, which leave out 0.1 rad a metre: truly an
// arc of one radian and a radius of ten metres.
TEST(WheelReckoningTest, EachStepIsCorrected) {
  const std::vector<Pose2> steps(1000, Pose2(0.01, 0., 0.));
  const ReckonedMotion reckoned = ReckonByWheels(steps, Calibrated(0.1), 0.);
  EXPECT_NEAR(reckoned.motion.pose.x, 10. * std::sin(1.), 1e-3);
  EXPECT_NEAR(reckoned.motion.pose.y, 10. * (1. - std::cos(1.)), 1e-3);
  EXPECT_NEAR(reckoned.motion.pose.theta, 1., 1e-9);
  EXPECT_NEAR(reckoned.length, 10., 1e-9);
}

// Ten metres forth, half a turn, ten metres back: the motion as a whole has no
// length that its scale or its heading could be corrected by.
TEST(WheelReckoningTest, ThePathIsWhatIsDriven) {
  std::vector<Pose2> steps(100, Pose2(0.1, 0., 0.));
  steps.push_back(Pose2(0., 0., kPi));
  steps.insert(steps.end(), 100, Pose2(0.1, 0., 0.));
  const ReckonedMotion reckoned = ReckonByWheels(steps, Calibrated(0.01), 0.);
  EXPECT_NEAR(reckoned.length, 20., 1e-9);
  // Both ways bend to the left, on circles of a hundred metres.
  const Pose2 arc(100. * std::sin(0.1), 100. * (1. - std::cos(0.1)), 0.1);
  const Pose2 expected = arc * Pose2(0., 0., kPi) * arc;
  EXPECT_NEAR(reckoned.motion.pose.x, expected.x, 1e-3);
  EXPECT_NEAR(reckoned.motion.pose.y, expected.y, 1e-3);
  EXPECT_NEAR(NormalizeAngle(reckoned.motion.pose.theta - expected.theta), 0.,
              1e-9);
}

// Sigmas of the options: heading 0.02 rad/m, rotation 3 %, scale 2 %. Two steps of
// a metre: a common heading error e turns the robot by e in the middle of nothing,
// so that the end of the second step is off by e times one metre.
TEST(WheelReckoningTest, CovarianceByHand) {
  const OdometryCalibration calibration = Calibrated(0.);
  const ReckonedMotion reckoned =
      ReckonByWheels({Pose2(1., 0., 0.), Pose2(1., 0., 0.)}, calibration, 0.);
  const double walk = calibration.RotationVariance(1., 0.);
  const double along = calibration.TranslationVariance(1.);
  const Eigen::Matrix3d& covariance = reckoned.motion.covariance;
  EXPECT_NEAR(covariance(0, 0), 2. * along + std::pow(2. * 0.02, 2), 1e-12);
  EXPECT_NEAR(covariance(1, 1), 2. * along + walk + 0.02 * 0.02, 1e-12);
  EXPECT_NEAR(covariance(2, 2), 2. * walk + std::pow(2. * 0.02, 2), 1e-12);
  EXPECT_NEAR(covariance(1, 2), walk + 0.02 * 2. * 0.02, 1e-12);
}

TEST(WheelReckoningTest, UnseenFaultsWiden) {
  const std::vector<Pose2> steps(100, Pose2(0.1, 0., 0.));
  const Eigen::Matrix3d without =
      ReckonByWheels(steps, Exact(), 0.).motion.covariance;
  const Eigen::Matrix3d with =
      ReckonByWheels(steps, Exact(), 0.01).motion.covariance;
  // A tenth of a fault of 0.8 m and 0.2 rad.
  EXPECT_NEAR(with(0, 0) - without(0, 0), 0.1 * 0.64, 1e-9);
  EXPECT_NEAR(with(2, 2) - without(2, 2), 0.1 * 0.04, 1e-9);
}

TEST(WheelReckoningTest, WithoutStepsNothingMoved) {
  const ReckonedMotion reckoned = ReckonByWheels({}, Exact(), 0.01);
  EXPECT_EQ(reckoned.length, 0.);
  EXPECT_TRUE(reckoned.motion.covariance.isZero(0.));
}

// Wheels drawn with the errors that are assumed, over a winding path of 24 m: their
// ends scatter as the covariance says.
TEST(WheelReckoningTest, IsAsWideAsTheErrors) {
  const OdometryCalibration calibration = Calibrated(0.);
  constexpr int kSteps = 120;
  std::vector<Pose2> path;
  for (int i = 0; i < kSteps; ++i) {
    path.push_back(Pose2(0.2, 0., 0.05 * std::sin(0.1 * i) + 0.01));
  }
  Pose2 truth;
  for (const Pose2& step : path) truth = truth * step;
  Random random(7);
  double chi_square = 0.;
  constexpr int kDraws = 2000;
  for (int draw = 0; draw < kDraws; ++draw) {
    const double heading = random.Normal(0., 0.002);
    const double turning = random.Normal(0., 0.03);
    const double scale = random.Normal(0., 0.02);
    std::vector<Pose2> wheels;
    for (const Pose2& step : path) {
      const double walk =
          std::sqrt(calibration.RotationVariance(0.2, std::abs(step.theta)));
      const double along = std::sqrt(calibration.TranslationVariance(0.2));
      wheels.push_back(Pose2((1. + scale) * step.x + random.Normal(0., along),
                             random.Normal(0., along),
                             (1. + turning) * step.theta + 0.2 * heading +
                                 random.Normal(0., walk)));
    }
    OdometryCalibrationOptions options;
    options.rotation_per_metre_sigma = 0.002;
    const uncertainty::UncertainPose reckoned =
        ReckonByWheels(wheels, OdometryCalibration(options), 0.).motion;
    const Pose2 error = Between(reckoned.pose, truth);
    const Eigen::Vector3d e(error.x, error.y, error.theta);
    chi_square += e.dot(reckoned.covariance.inverse() * e) / kDraws;
  }
  EXPECT_NEAR(chi_square, 3., 0.3);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
