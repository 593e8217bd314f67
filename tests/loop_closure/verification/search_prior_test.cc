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
  PredictedMatch match;
  // Two sigma ahead and one of the heading: exp(-2.5).
  match.displacement =
      Pose2(2. * std::cos(1.), 2. * std::sin(1.), 2. * kPi - 0.1);
  match.translation_sigma = 1.;
  match.rotation_sigma = 0.1;
  const double gaussian = std::exp(-2.5) / (std::pow(2. * kPi, 1.5) * 0.1);
  EXPECT_NEAR(PredictedDensity(match), gaussian, 1e-12);
  EXPECT_NEAR(TrueDensity(2., 4., 0.5), 0.9 * 3. + 0.1 * 0.5, 1e-12);
}

TEST(SearchPriorTest, TheDensityIsOneInAll) {
  constexpr int kSteps = 60;
  constexpr double kLinear = 3., kAngular = 0.3;
  const double volume = SearchVolume(kLinear, kAngular);
  PredictedMatch match;
  match.translation_sigma = 0.5;
  match.rotation_sigma = 0.05;
  const auto at = [](const int n, const double half) {
    return half * ((n + 0.5) / kSteps * 2. - 1.);
  };
  double sum = 0.;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      for (int k = 0; k < kSteps; ++k) {
        match.displacement =
            Pose2(at(i, kLinear), at(j, kLinear), at(k, kAngular));
        sum += PredictedDensity(match);
      }
    }
  }
  EXPECT_NEAR(sum * volume / (kSteps * kSteps * kSteps), 1., 1e-3);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
