// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/search_prior.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(SearchPriorTest, VolumeByHand) {
  EXPECT_NEAR(SearchVolume(3., 0.3), 6. * 6. * 0.6, 1e-12);
}

TEST(SearchPriorTest, DensityByHand) {
  // Two sigma ahead, one to the side and one of the heading: exp(-3).
  const Eigen::Matrix3d covariance =
      Eigen::Vector3d(4., 0.25, 0.01).asDiagonal();
  const double gaussian = std::exp(-3.) / (std::pow(2. * kPi, 1.5) * 0.1);
  EXPECT_NEAR(PredictedDensity(Pose2(4., -0.5, 2. * kPi - 0.1), covariance),
              gaussian, 1e-12);
  EXPECT_NEAR(TrueDensity(2., 4., 0.5), 0.9 * 3. + 0.1 * 0.5, 1e-12);
}

// Of equal scores the density decides: ln 3. A score that is better by 0.1
// outweighs five nats, and nothing is less likely than anywhere in the search.
TEST(SearchPriorTest, LikelihoodByHand) {
  EXPECT_NEAR(
      LogLikelihoodOfMatch(0.6, 3.2, 1.1) - LogLikelihoodOfMatch(0.6, 1., 0.9),
      std::log((0.9 * 3.2 + 0.11) / (0.9 + 0.09)), 1e-12);
  EXPECT_NEAR(
      LogLikelihoodOfMatch(0.7, 1., 1.) - LogLikelihoodOfMatch(0.6, 1., 1.), 5.,
      1e-12);
  EXPECT_NEAR(LogLikelihoodOfMatch(0.5, 0., 0.02), 25. + std::log(0.002),
              1e-12);
}

TEST(SearchPriorTest, TheDensityIsOneInAll) {
  constexpr int kSteps = 60;
  constexpr double kLinear = 3., kAngular = 0.3;
  const double volume = SearchVolume(kLinear, kAngular);
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.3, 0.2, 0.0025).asDiagonal();
  covariance(0, 1) = covariance(1, 0) = 0.1;
  const auto at = [](const int n, const double half) {
    return half * ((n + 0.5) / kSteps * 2. - 1.);
  };
  double sum = 0.;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      for (int k = 0; k < kSteps; ++k) {
        sum += PredictedDensity(
            Pose2(at(i, kLinear), at(j, kLinear), at(k, kAngular)), covariance);
      }
    }
  }
  EXPECT_NEAR(sum * volume / (kSteps * kSteps * kSteps), 1., 1e-3);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
