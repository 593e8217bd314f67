// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/consensus/path_agreement.h"

#include <cmath>
#include <vector>

#include "Eigen/LU"
#include "cartographer_ext/common/random.h"
#include "cartographer_ext/uncertainty/drift_estimator.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/uncertainty/random_walk.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

PathAgreement Agreement(const double length, const double chi_square,
                        const double wrong_density = 1.) {
  PathAgreement agreement;
  agreement.length = length;
  agreement.chi_square = chi_square;
  agreement.wrong_density = wrong_density;
  return agreement;
}

PathSample Sample(const double chi_square, const double share = 1.) {
  PathSample sample;
  sample.agreement = Agreement(1000., chi_square);
  sample.probability = 0.5;
  sample.share = share;
  return sample;
}

// 6^3 / (2 pi)^1.5 = 13.7147.
TEST(PathAgreementTest, DensitiesComputedByHand) {
  // A short path has the factor one.
  EXPECT_NEAR(DensityOfRight(Agreement(20., 2.), 0.25), 13.7147 * std::exp(-1.),
              1e-4);
  // One of 60 m is not better known than one of 30 m.
  EXPECT_NEAR(DensityOfRight(Agreement(60., 2.), 0.25),
              13.7147 / std::pow(0.5, 1.5) * std::exp(-2.), 1e-4);
  EXPECT_NEAR(DensityOfRight(Agreement(300., 2.), 0.25),
              13.7147 / 0.125 * std::exp(-4.), 1e-4);
}

TEST(PathAgreementTest, OddsHaveAShareOfUnexpectedOnes) {
  EXPECT_NEAR(OddsByPath(Agreement(20., 2., 0.5), 0.25),
              0.9 * 13.7147 * std::exp(-1.) / 0.5 + 0.1, 1e-4);
  EXPECT_NEAR(OddsByPath(Agreement(20., 1000.), 1.), 0.1, 1e-12);
}

TEST(PathAgreementTest, ComparesALoopWithItsPath) {
  uncertainty::PathUncertainty paths(uncertainty::RandomWalk(), 100);
  for (int i = 0; i <= 40; ++i) {
    paths.Add(uncertainty::NodeId{0, i}, Pose2(i, 0., 0.));
    paths.Add(uncertainty::NodeId{1, i}, Pose2(i, 0., 0.));
  }
  uncertainty::LoopEdge loop;
  loop.a = uncertainty::NodeId{0, 0};
  loop.b = uncertainty::NodeId{0, 40};
  loop.pose.pose = Pose2(40.3, 0., 0.);
  loop.pose.covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal();
  const PathAgreement agreement = AgreementWithPath(paths, loop, 0.02);
  EXPECT_DOUBLE_EQ(agreement.length, 40.);
  // (0.3 m)^2 / (40 (0.05 m)^2 + 0.01 m^2)
  EXPECT_NEAR(agreement.chi_square, 0.09 / 0.11, 1e-6);
  const Eigen::Matrix3d covariance =
      paths.Between(loop.a, loop.b)->covariance + loop.pose.covariance;
  EXPECT_NEAR(agreement.wrong_density,
              0.02 * 216. * std::sqrt(covariance.determinant()), 1e-3);
  EXPECT_LT(agreement.wrong_density, 1.);
  // Denser than within the three standard deviations: a search by something that
  // knew more than the path.
  EXPECT_DOUBLE_EQ(AgreementWithPath(paths, loop, 100.).wrong_density, 1.);
  // Nothing is known without a density, and without a path.
  EXPECT_FALSE(AgreementWithPath(paths, loop, 0.).is_known());
  loop.b = uncertainty::NodeId{1, 40};
  EXPECT_FALSE(AgreementWithPath(paths, loop, 0.02).is_known());
}

TEST(PathAgreementTest, LearnsHowGoodLongPathsAre) {
  EXPECT_DOUBLE_EQ(LearnPathFactor({}), 1.);
  const std::vector<PathSample> good(10, Sample(0.1));
  EXPECT_LT(LearnPathFactor(good), 0.1);
  // The same path seen ten times tells less.
  const double of_one_path =
      LearnPathFactor(std::vector<PathSample>(10, Sample(0.1, 0.1)));
  EXPECT_GT(of_one_path, 2. * LearnPathFactor(good));
  EXPECT_LT(of_one_path, 1.);
  // As good as assumed, and worse.
  EXPECT_GT(LearnPathFactor(std::vector<PathSample>(10, Sample(3.))), 0.8);
  EXPECT_DOUBLE_EQ(LearnPathFactor(std::vector<PathSample>(10, Sample(8.))),
                   1.);
  // An impossible one does not hide it, nor a certain one rule it out.
  std::vector<PathSample> impossible = good;
  impossible.push_back(Sample(1e6));
  impossible.back().probability = 1.;
  EXPECT_LT(LearnPathFactor(impossible), 0.1);
  // Wrong loops, all of them one place off, do not hide it.
  std::vector<PathSample> mixed = good;
  mixed.insert(mixed.end(), 20, Sample(5.));
  EXPECT_LT(LearnPathFactor(mixed), 0.2);
}

// Right loops with a factor drawn from the prior, among as many wrong ones.
TEST(PathAgreementTest, TheFactorIsAnUpperBoundInNineOfTen) {
  const uncertainty::DriftEstimatorOptions prior;
  int num_bounded = 0;
  double log_excess = 0.;
  constexpr int kRuns = 300;
  for (int seed = 1; seed <= kRuns; ++seed) {
    Random random(seed);
    const double truth = std::exp(
        2. * (prior.prior_translation + prior.prior_sigma * random.Normal()));
    std::vector<PathSample> samples;
    for (int i = 0; i < 40; ++i) {
      double chi_square = 0.;
      for (int axis = 0; axis < 3; ++axis) {
        const double offset = i % 2 == 0 ? std::sqrt(truth) * random.Normal()
                                         : random.Uniform(-3., 3.);
        chi_square += offset * offset;
      }
      samples.push_back(Sample(chi_square));
    }
    const double factor = LearnPathFactor(samples);
    num_bounded += factor >= std::min(1., truth);
    log_excess += std::log(factor / std::min(1., std::max(0.03, truth)));
  }
  EXPECT_GE(num_bounded, 0.87 * kRuns);
  // And a close one.
  EXPECT_LT(log_excess / kRuns, std::log(2.));
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
