// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/uncertainty/drift_estimator.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

TEST(DriftEstimatorTest, PriorIsWide) {
  const DriftEstimator estimator{DriftEstimatorOptions()};
  const DriftFit fit = estimator.Fit();
  EXPECT_NEAR(fit.mean.turning, 1., 0.3);
  EXPECT_DOUBLE_EQ(fit.mean.turning, fit.mean.rotation);
  // The 90 percent point of a normal distribution lies at 1.28 sigma, that of
  // the translation at a factor of one.
  EXPECT_NEAR(std::log(fit.upper.turning), 1.28 * 1.15, 0.3);
  EXPECT_NEAR(std::log(fit.mean.translation), -1.28 * 1.15, 0.3);
  EXPECT_NEAR(std::log(fit.upper.translation), 0., 0.15);
  EXPECT_EQ(estimator.num_cycles(), 0);
}

TEST(DriftEstimatorTest, OneClosedCycleDoesNotWidenTheTranslation) {
  DriftEstimator estimator{DriftEstimatorOptions()};
  DriftCycle cycle;
  cycle.parts = Parts();
  cycle.error = Eigen::Vector3d(0.03, -0.02, 0.004);
  estimator.Add(cycle);
  EXPECT_LT(estimator.Fit().upper.translation, 1.1);
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

// Twenty right cycles among a hundred. No draw takes the wrong ones for drift. A
// factor of 0.7 is hidden by the noise of the loops here and single draws follow
// the prior, so only their median has to find it.
TEST(DriftEstimatorTest, MostLoopsMayBeWrong) {
  for (const double truth : {0.7, 5.}) {
    std::vector<double> errors;
    for (const int seed : {12, 13, 14, 15, 16}) {
      DriftEstimator estimator{DriftEstimatorOptions()};
      Random random(seed);
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
      errors.push_back(std::log(fit.mean.translation / truth));
      EXPECT_LT(errors.back(), 0.5) << truth << " " << seed;
      // What acts.
      EXPECT_NEAR(
          std::log(std::max(1., fit.upper.translation) / std::max(1., truth)),
          0., 0.5)
          << truth << " " << seed;
      EXPECT_LT(fit.mean.turning, 2.5) << truth << " " << seed;
      EXPECT_NEAR(fit.wrong_share, 0.8, 0.15) << truth << " " << seed;
      EXPECT_LT(fit.aligned_share, 0.3) << truth << " " << seed;
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_NEAR(errors[2], 0., 0.5) << truth;
  }
}

// One wrong cycle, 4 m off. Of a heading as a right one has, with a sigma of
// s = sqrt(2.5e-4 + 3.5e-4 + 2e-4) = 0.0283 rad, it is aligned by the odds
// h N(0; 0, s^2) : (1 - h) = 14.1 h : 1 - h, so that h = (1 + 14.1 h / (1 +
// 13.1 h)) / 3 = 0.655. 0.3 rad off it is not: h = (1 + 0) / 3.
TEST(DriftEstimatorTest, ParallelPlacesAreToldByTheirHeading) {
  for (const bool parallel : {true, false}) {
    DriftEstimator estimator{DriftEstimatorOptions()};
    EXPECT_DOUBLE_EQ(estimator.Fit().aligned_share, 0.5);
    DriftCycle cycle;
    cycle.parts = Parts();
    cycle.error = Eigen::Vector3d(4., 0., parallel ? 0. : 0.3);
    estimator.Add(cycle);
    EXPECT_NEAR(estimator.Fit().aligned_share, parallel ? 0.655 : 1. / 3.,
                0.01);
  }
}

// The heading of a cycle and nothing else: one over 0.3 rad, with the effects of
// 50 m and of what is left of a full circle without that error.
TEST(DriftEstimatorTest, HeadingByHand) {
  UncertainPose loop;
  loop.pose = Pose2(3., 1., 0.5);
  loop.covariance = Diagonal(1e-3, 1e-3, 1e-4);
  DriftStretch path;
  path.pose = Pose2(7., -2., -0.2);
  path.parts.rotation = Diagonal(0.1, 0.1, 2e-3);
  path.parts.turning = Diagonal(0.1, 0.1, 3e-3);
  path.parts.common.row(2) << 50., 2. * kPi, 0.;
  const HeadingCycle heading = HeadingOfLoop(loop, path);
  EXPECT_NEAR(heading.error, 0.3, 1e-12);
  EXPECT_NEAR(heading.rotation, 2e-3, 1e-12);
  EXPECT_NEAR(heading.turning, 3e-3, 1e-12);
  EXPECT_NEAR(heading.other, 1e-4, 1e-12);
  EXPECT_NEAR(heading.common.x(), 50., 1e-12);
  EXPECT_NEAR(heading.common.y(), 2. * kPi - 0.3, 1e-12);
  EXPECT_EQ(heading.common.z(), 0.);
}

// Two paths side by side, ten metres each, of which one is measured 0.2 m too long
// and turned by 0.01 rad: there is nothing that a wrong scale or turning would do.
TEST(DriftEstimatorTest, EffectsAreThoseWithoutTheErrorOfTheCycle) {
  UncertainPose loop;
  DriftStretch there, back;
  there.pose = Pose2(10.2, 0., 0.01);
  back.pose = Pose2(10., 0., 0.).Inverse();
  there.parts.common.col(1) = Eigen::Vector3d(0., 0., 0.01);
  there.parts.common.col(2).head<2>() = -there.pose.Inverse().translation();
  back.parts.common.col(2).head<2>() = -back.pose.Inverse().translation();
  const DriftCycle cycle = CycleOfLoops(loop, there, loop, back);
  EXPECT_NEAR(cycle.error.z(), 0.01, 1e-12);
  EXPECT_GT(cycle.error.head<2>().norm(), 0.2);
  EXPECT_NEAR(cycle.parts.common(2, 1), 0., 1e-12);
  // Up to products of errors: 0.2 m * 0.01 rad + 10 m * (0.01 rad)^2 / 2.
  EXPECT_LT(cycle.parts.common.col(2).head<2>().norm(), 0.0025);
}

// Headings over 100 m that are a fifth of what is expected of them.
std::vector<HeadingCycle> Headings(const double factor, const int count) {
  std::vector<HeadingCycle> headings;
  Random random(4);
  for (int i = 0; i < count; ++i) {
    HeadingCycle heading;
    heading.rotation = 2.5e-3;
    heading.turning = 1e-3;
    heading.other = 1e-5;
    heading.common << 100., random.Uniform(-6., 6.), 0.;
    heading.length = 100.;
    heading.error = random.Normal(0., factor * std::sqrt(3.5e-3));
    headings.push_back(heading);
  }
  return headings;
}

TEST(DriftEstimatorTest, LongPathsTellTheRotation) {
  DriftEstimator estimator{DriftEstimatorOptions()};
  const DriftFit before = estimator.Fit();
  estimator.SetHeadings(Headings(0.2, 40), 4000.);
  const DriftFit fit = estimator.Fit();
  EXPECT_LT(fit.upper.rotation, 0.6);
  EXPECT_LT(fit.common.covariance(0, 0), 0.01 * before.common.covariance(0, 0));
  EXPECT_NEAR(fit.mean.translation, before.mean.translation, 0.05);
  // A tenth of the path: they repeat each other, and tell less.
  estimator.SetHeadings(Headings(0.2, 40), 400.);
  EXPECT_GT(estimator.Fit().upper.rotation, 1.2 * fit.upper.rotation);
  EXPECT_GT(estimator.Fit().common.covariance(0, 0),
            5. * fit.common.covariance(0, 0));
  // One in ten is a place of another heading.
  std::vector<HeadingCycle> headings = Headings(0.2, 40);
  for (size_t i = 0; i < headings.size(); i += 10) headings[i].error = 0.5;
  estimator.SetHeadings(headings, 4000.);
  EXPECT_LT(estimator.Fit().upper.rotation, 0.8);
  // Where nearly all loops are right, a heading that drifts is not explained by
  // wrong ones.
  Random random(9);
  for (int i = 0; i < 40; ++i) estimator.Add(Draw(DriftFactors(), &random));
  estimator.SetHeadings(Headings(3., 40), 4000.);
  const DriftFactors wide = estimator.Fit().mean;
  EXPECT_GT(std::max(wide.rotation, wide.turning), 1.5);
}

TEST(DriftEstimatorTest, HeadingsTellWhatIsTheSameAllAlong) {
  DriftEstimator estimator{DriftEstimatorOptions()};
  std::vector<HeadingCycle> headings = Headings(0.2, 40);
  const Eigen::Vector3d truth(0.001, -0.02, 0.);
  for (HeadingCycle& heading : headings) {
    heading.error -= heading.common.dot(truth);
  }
  estimator.SetHeadings(headings, 4000.);
  const CommonDrift found = estimator.Fit().common;
  for (int k = 0; k < 2; ++k) {
    const double sigma = std::sqrt(found.covariance(k, k));
    EXPECT_NEAR(found.mean(k), truth(k), 3. * sigma) << k;
    EXPECT_LT(sigma, 0.3 * std::abs(truth(k))) << k;
  }
}

// Half a radian along the run, while every short cycle closes as if there were
// none (both of its paths drift alike): of all loops over long paths the heading is
// off by many of its standard deviations, and yet they are right.
TEST(DriftEstimatorTest, AConstantDriftIsFoundFromFarAway) {
  for (const double drift : {-0.0012, 0.003}) {
    DriftEstimator estimator{DriftEstimatorOptions()};
    Random random(23);
    DriftFactors factors;
    factors.rotation = factors.turning = 0.2;
    for (int i = 0; i < 100; ++i) estimator.Add(Draw(factors, &random));
    std::vector<HeadingCycle> headings;
    for (int i = 0; i < 30; ++i) {
      HeadingCycle heading;
      heading.length = random.Uniform(150., 400.);
      heading.rotation = 2.5e-5 * heading.length;
      heading.turning = 2.25e-4 * 20.;
      heading.other = 1e-5;
      heading.common = Eigen::Vector3d(-heading.length, -6., 0.);
      heading.error = drift * heading.length +
                      random.Normal(0., 0.2 * std::sqrt(heading.rotation +
                                                        heading.turning));
      headings.push_back(heading);
    }
    estimator.SetHeadings(headings, 1500.);
    const DriftFit fit = estimator.Fit();
    EXPECT_NEAR(fit.common.mean(0), drift, 0.1 * std::abs(drift));
    EXPECT_LT(fit.mean.rotation, 1.);
  }
}

// The density of wrong loops follows the window between its limits.
TEST(DriftEstimatorTest, WindowsHaveLimits) {
  const auto wrong_share = [](const double window) {
    DriftEstimator estimator{DriftEstimatorOptions()};
    Random random(8);
    DriftFactors factors;
    factors.translation = 3.;
    for (int i = 0; i < 40; ++i) {
      DriftCycle cycle = Draw(factors, &random);
      cycle.window = window;
      estimator.Add(cycle);
    }
    return estimator.Fit().wrong_share;
  };
  EXPECT_EQ(wrong_share(0.5), wrong_share(2.));
  EXPECT_EQ(wrong_share(5.), wrong_share(15.));
  EXPECT_GT(wrong_share(2.), wrong_share(5.));
}

// Shelves every 2.4 m in parallel aisles 3.6 m apart: up to four of five loops
// take one place for another.
TEST(DriftEstimatorTest, EqualPlacesAreNoDrift) {
  for (const double share : {0.2, 0.4, 0.6, 0.8}) {
    for (const double truth : {0.1, 1.}) {
      DriftEstimator estimator{DriftEstimatorOptions()};
      Random random(7);
      DriftFactors factors;
      factors.translation = factors.rotation = factors.turning = truth;
      for (int i = 0; i < 60; ++i) {
        DriftCycle cycle = Draw(factors, &random);
        if (random.Uniform() < share) {
          const int places = static_cast<int>(random.UniformInt(1, 3));
          const int aisles = static_cast<int>(random.UniformInt(-1, 1));
          cycle.error.x() += 2.4 * (random.Uniform() < 0.5 ? places : -places);
          cycle.error.y() += 3.6 * aisles;
        }
        estimator.Add(cycle);
      }
      const DriftFit fit = estimator.Fit();
      EXPECT_LT(fit.upper.translation, 2.) << share << " " << truth;
      EXPECT_GT(fit.aligned_share, 0.6) << share << " " << truth;
    }
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
