// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/uncertain_pose.h"

#include <limits>

#include "Eigen/Cholesky"
#include "Eigen/LU"
#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

Pose2 Exp(const Eigen::Vector3d& error) {
  return Pose2(error.x(), error.y(), error.z());
}

// e of  truth = estimate Exp(e).
Eigen::Vector3d Error(const Pose2& estimate, const Pose2& truth) {
  const Pose2 error = Between(estimate, truth);
  return Eigen::Vector3d(error.x, error.y, error.theta);
}

// Derivative of the error that `map` makes of an error of `estimate`.
template <typename Map>
Eigen::Matrix3d NumericJacobian(const Pose2& estimate, const Map& map) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d jacobian;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    jacobian.col(k) = (Error(map(estimate), map(estimate * Exp(step))) -
                       Error(map(estimate), map(estimate * Exp(-step)))) /
                      (2. * kStep);
  }
  return jacobian;
}

// A full covariance with correlations; standard deviations of about `sigma`.
Eigen::Matrix3d Covariance(const double sigma) {
  Eigen::Matrix3d root;
  root << 1., 0.3, 0.1, -0.2, 1.5, 0.4, 0.1, -0.3, 0.5;
  return sigma * sigma * root * root.transpose();
}

UncertainPose Make(const Pose2& pose, const Eigen::Matrix3d& covariance) {
  UncertainPose result;
  result.pose = pose;
  result.covariance = covariance;
  return result;
}

const Pose2 kFirst(3., -1., 0.8);
const Pose2 kSecond(-0.5, 2., -2.1);

TEST(UncertainPoseTest, WorstTranslationSigmaByHand) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // Deviations of 2 and 1 m along the diagonals.
  covariance << 2.5, 1.5, 0.7, 1.5, 2.5, 0.2, 0.7, 0.2, 9.;
  EXPECT_NEAR(WorstTranslationSigma(covariance), 2., 1e-12);
  EXPECT_EQ(WorstTranslationSigma(Eigen::Matrix3d::Zero()), 0.);
}

TEST(UncertainPoseTest, HeadingErrorGrowsWithTheLeverArm) {
  const UncertainPose turn =
      Make(Pose2(), Eigen::Vector3d(0., 0., 1e-4).asDiagonal());
  const UncertainPose ahead = Make(Pose2(10., 0., 0.), Eigen::Matrix3d::Zero());
  const UncertainPose sum = Compose(turn, ahead);
  EXPECT_NEAR(sum.covariance(1, 1), 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(sum.covariance(0, 0), 0., 1e-12);
  EXPECT_NEAR(sum.covariance(1, 2), 0.1 * 0.01, 1e-12);
}

TEST(UncertainPoseTest, CompositionHasTheNumericDerivatives) {
  const Eigen::Matrix3d covariance = Covariance(0.1);
  const Eigen::Matrix3d of_first = NumericJacobian(
      kFirst, [](const Pose2& first) { return first * kSecond; });
  const UncertainPose from_first =
      Compose(Make(kFirst, covariance), Make(kSecond, Eigen::Matrix3d::Zero()));
  EXPECT_TRUE(from_first.covariance.isApprox(
      of_first * covariance * of_first.transpose(), 1e-6));
  const Eigen::Matrix3d of_second = NumericJacobian(
      kSecond, [](const Pose2& second) { return kFirst * second; });
  const UncertainPose from_second =
      Compose(Make(kFirst, Eigen::Matrix3d::Zero()), Make(kSecond, covariance));
  EXPECT_TRUE(from_second.covariance.isApprox(
      of_second * covariance * of_second.transpose(), 1e-6));
}

TEST(UncertainPoseTest, InverseHasTheNumericDerivative) {
  const Eigen::Matrix3d covariance = Covariance(0.1);
  const Eigen::Matrix3d jacobian =
      NumericJacobian(kFirst, [](const Pose2& pose) { return pose.Inverse(); });
  const UncertainPose inverse = Invert(Make(kFirst, covariance));
  EXPECT_TRUE(inverse.covariance.isApprox(
      jacobian * covariance * jacobian.transpose(), 1e-6));
  const UncertainPose back = Invert(inverse);
  EXPECT_NEAR(back.pose.x, kFirst.x, 1e-12);
  EXPECT_TRUE(back.covariance.isApprox(covariance, 1e-10));
}

TEST(UncertainPoseTest, BetweenHasTheNumericDerivatives) {
  const Eigen::Matrix3d covariance = Covariance(0.1);
  const Eigen::Matrix3d of_first = NumericJacobian(
      kFirst, [](const Pose2& first) { return Between(first, kSecond); });
  const Eigen::Matrix3d of_second = NumericJacobian(
      kSecond, [](const Pose2& second) { return Between(kFirst, second); });
  const UncertainPose between =
      Between(Make(kFirst, covariance), Make(kSecond, 2. * covariance));
  EXPECT_TRUE(between.covariance.isApprox(
      of_first * covariance * of_first.transpose() +
          2. * of_second * covariance * of_second.transpose(),
      1e-6));
  EXPECT_NEAR(between.pose.x, Between(kFirst, kSecond).x, 1e-12);
}

// The covariance of sampled errors, over composition, inverse and between.
TEST(UncertainPoseTest, MonteCarlo) {
  Random random(11);
  const UncertainPose first = Make(kFirst, Covariance(0.01));
  const UncertainPose second = Make(kSecond, Covariance(0.02));
  const UncertainPose composed = Compose(first, second);
  const UncertainPose inverse = Invert(composed);
  const UncertainPose between = Between(first, second);
  const auto sample = [&random](const UncertainPose& estimate) {
    const Eigen::Matrix3d root = estimate.covariance.llt().matrixL();
    const double x = random.Normal(0., 1.), y = random.Normal(0., 1.);
    return estimate.pose *
           Exp(root * Eigen::Vector3d(x, y, random.Normal(0., 1.)));
  };
  Eigen::Matrix3d of_composed = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d of_inverse = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d of_between = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const Pose2 a = sample(first);
    const Pose2 b = sample(second);
    const Eigen::Vector3d composed_error = Error(composed.pose, a * b);
    const Eigen::Vector3d inverse_error =
        Error(inverse.pose, (a * b).Inverse());
    const Eigen::Vector3d between_error = Error(between.pose, Between(a, b));
    of_composed += composed_error * composed_error.transpose() / kSamples;
    of_inverse += inverse_error * inverse_error.transpose() / kSamples;
    of_between += between_error * between_error.transpose() / kSamples;
  }
  EXPECT_TRUE(of_composed.isApprox(composed.covariance, 0.03)) << of_composed;
  EXPECT_TRUE(of_inverse.isApprox(inverse.covariance, 0.03)) << of_inverse;
  EXPECT_TRUE(of_between.isApprox(between.covariance, 0.03)) << of_between;
}

TEST(UncertainPoseTest, InvertsCovariancesOfMetresAndRadians) {
  const Eigen::Matrix3d round = Covariance(1.);
  const Eigen::DiagonalMatrix<double, 3> scale(1., 1., 1e-6);
  Eigen::Matrix3d information;
  ASSERT_TRUE(InvertCovariance(scale * round * scale, &information));
  EXPECT_TRUE(Eigen::Matrix3d(scale * information * scale)
                  .isApprox(round.inverse(), 1e-9));
  EXPECT_FALSE(InvertCovariance(Eigen::Matrix3d::Zero(), &information));
  EXPECT_FALSE(InvertCovariance(-Eigen::Matrix3d::Identity(), &information));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
      InvertCovariance(nan * Eigen::Matrix3d::Identity(), &information));
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
