// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_estimator.h"

#include <cmath>

#include "Eigen/Cholesky"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/uncertainty/cycle_consistency.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace uncertainty {
namespace {

Eigen::Matrix3d Diagonal(const double x, const double y, const double theta) {
  return Eigen::Vector3d(x, y, theta).asDiagonal();
}

// About ten metres with a right angle, by two good loops.
CovarianceParts Parts() {
  CovarianceParts parts;
  parts.translation = Diagonal(0.025, 0.025, 0.);
  parts.rotation = Diagonal(0.002, 0.002, 2.5e-4);
  parts.rotation(0, 2) = parts.rotation(2, 0) = 4e-4;
  parts.turning = Diagonal(0.002, 0.002, 3.5e-4);
  parts.other = Diagonal(0.005, 0.005, 2e-4);
  return parts;
}

DriftCycle Draw(const DriftFactors& factors, Random* const random) {
  DriftCycle cycle;
  cycle.parts = Parts();
  const Eigen::Matrix3d lower =
      cycle.parts.Total(factors, Eigen::Matrix3d::Zero()).llt().matrixL();
  cycle.error = lower * Eigen::Vector3d(random->Normal(), random->Normal(),
                                        random->Normal());
  return cycle;
}

TEST(DriftEstimatorTest, PriorIsWideAndCentred) {
  const DriftEstimator estimator{DriftEstimatorOptions()};
  const DriftFactors mean = estimator.Fit().mean;
  EXPECT_NEAR(mean.translation, 1., 0.3);
  EXPECT_DOUBLE_EQ(mean.translation, mean.rotation);
  EXPECT_DOUBLE_EQ(mean.translation, mean.turning);
  // The 90 percent point of a normal distribution lies at 1.28 sigma.
  EXPECT_NEAR(std::log(estimator.Fit().upper.turning), 1.28 * 1.15, 0.3);
  EXPECT_EQ(estimator.num_cycles(), 0);
}

TEST(DriftEstimatorTest, FindsTheFactors) {
  for (const double truth : {0.5, 1., 4.}) {
    DriftEstimator estimator{DriftEstimatorOptions()};
    Random random(17);
    DriftFactors factors;
    factors.translation = truth;
    for (int i = 0; i < 200; ++i) estimator.Add(Draw(factors, &random));
    EXPECT_NEAR(std::log(estimator.Fit().mean.translation / truth), 0., 0.2)
        << truth;
    EXPECT_GT(estimator.Fit().upper.translation,
              estimator.Fit().mean.translation);
    EXPECT_LT(estimator.Fit().upper.translation,
              1.4 * estimator.Fit().mean.translation);
    EXPECT_EQ(estimator.num_cycles(), 200);
  }
}

TEST(DriftEstimatorTest, TellsTurningFromTranslation) {
  DriftEstimator estimator{DriftEstimatorOptions()};
  Random random(3);
  DriftFactors factors;
  factors.turning = 6.;
  for (int i = 0; i < 200; ++i) estimator.Add(Draw(factors, &random));
  EXPECT_NEAR(std::log(estimator.Fit().mean.turning / 6.), 0., 0.25);
  EXPECT_NEAR(std::log(estimator.Fit().mean.translation), 0., 0.25);
}

TEST(DriftEstimatorTest, FindsWhatIsTheSameAllAlong) {
  const Eigen::Vector3d truth(0.002, -0.02, 0.03);
  DriftEstimator estimator{DriftEstimatorOptions()};
  Random random(21);
  for (int i = 0; i < 200; ++i) {
    DriftCycle cycle = Draw(DriftFactors(), &random);
    // Stretches of some metres with a turn to either side.
    cycle.parts.common << 0., 0., random.Uniform(-5., 5.), 0., 0.,
        random.Uniform(-5., 5.), random.Uniform(-10., 10.),
        random.Uniform(-2., 2.), 0.;
    cycle.error -= cycle.parts.common * truth;
    estimator.Add(cycle);
  }
  const CommonDrift found = estimator.Fit().common;
  for (int k = 0; k < 3; ++k) {
    const double sigma = std::sqrt(found.covariance(k, k));
    EXPECT_NEAR(found.mean(k), truth(k), 3. * sigma) << k;
    EXPECT_LT(sigma, 0.3 * std::abs(truth(k))) << k;
  }
  EXPECT_LT(estimator.Fit().mean.translation, 1.5);
}

TEST(DriftEstimatorTest, FewCyclesLeaveRoom) {
  DriftEstimator few{DriftEstimatorOptions()}, many{DriftEstimatorOptions()};
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const DriftCycle cycle = Draw(DriftFactors(), &random);
    if (i < 3) few.Add(cycle);
    many.Add(cycle);
  }
  EXPECT_GT(few.Fit().upper.translation / few.Fit().mean.translation,
            1.3 * many.Fit().upper.translation / many.Fit().mean.translation);
}

TEST(DriftEstimatorTest, WrongLoopsDoNotCount) {
  DriftEstimator estimator{DriftEstimatorOptions()};
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    DriftCycle cycle = Draw(DriftFactors(), &random);
    // Every tenth is one door farther on.
    if (i % 10 == 0) cycle.error.x() += 3.6;
    estimator.Add(cycle);
  }
  EXPECT_LT(estimator.Fit().mean.translation, 1.3);
}

TEST(DriftEstimatorTest, MostLoopsMayBeWrong) {
  for (const double truth : {0.7, 5.}) {
    DriftEstimator estimator{DriftEstimatorOptions()};
    Random random(12);
    DriftFactors factors;
    factors.translation = truth;
    for (int i = 0; i < 100; ++i) {
      DriftCycle cycle = Draw(factors, &random);
      // Four of five lie anywhere within some metres.
      if (i % 5 != 0) {
        cycle.error =
            Eigen::Vector3d(random.Uniform(-4., 4.), random.Uniform(-4., 4.),
                            random.Uniform(-0.5, 0.5));
      }
      estimator.Add(cycle);
    }
    const DriftFit fit = estimator.Fit();
    EXPECT_NEAR(std::log(fit.mean.translation / truth), 0., 0.5) << truth;
    EXPECT_LT(fit.mean.turning, 2.5) << truth;
    EXPECT_NEAR(fit.wrong_share, 0.8, 0.15) << truth;
  }
}

TEST(DriftEstimatorTest, CyclesHaveTheCovarianceOfTheCycleTest) {
  const Pose2 a_v(1., 2., 0.3), a_u(2., 2.5, 0.6), b_u(7., -1., 2.),
      b_v(8., -2., 1.5);
  CovarianceParts parts_a = Parts(), parts_b = Parts();
  parts_b.translation *= 2.;
  UncertainPose loop_u{Between(a_u, b_u), Diagonal(0.01, 0.02, 0.001)};
  UncertainPose loop_v{Between(a_v, b_v), Diagonal(0.03, 0.01, 0.002)};
  loop_u.pose = loop_u.pose * Pose2(0.1, -0.05, 0.02);
  DriftFactors factors;
  factors.translation = 2.;
  factors.rotation = 3.;
  factors.turning = 0.5;
  const DriftStretch path_b{Between(b_u, b_v), parts_b};
  const DriftStretch path_a{Between(a_v, a_u), parts_a};
  const DriftCycle cycle = CycleOfLoops(loop_u, path_b, loop_v, path_a);
  const CycleResult expected =
      TestCycle(CycleConsistencyOptions(), loop_u,
                UncertainPose{path_b.pose,
                              parts_b.Total(factors, Eigen::Matrix3d::Zero())},
                loop_v,
                UncertainPose{path_a.pose,
                              parts_a.Total(factors, Eigen::Matrix3d::Zero())});
  EXPECT_NEAR((cycle.parts.Total(factors, Eigen::Matrix3d::Zero()) -
               expected.covariance)
                  .norm(),
              0., 1e-12);
  EXPECT_NEAR(cycle.error.x(), expected.error.x, 1e-12);
  EXPECT_NEAR(cycle.error.z(), expected.error.theta, 1e-12);

  const DriftStretch back{Between(b_u, a_u), parts_b};
  const DriftCycle single = CycleOfLoop(loop_u, back);
  const UncertainPose composed = Compose(
      loop_u, UncertainPose{back.pose,
                            parts_b.Total(factors, Eigen::Matrix3d::Zero())});
  EXPECT_NEAR((single.parts.Total(factors, Eigen::Matrix3d::Zero()) -
               composed.covariance)
                  .norm(),
              0., 1e-12);
  EXPECT_NEAR(single.error.y(), composed.pose.y, 1e-12);
}

}  // namespace
}  // namespace uncertainty
}  // namespace cartographer_ext
