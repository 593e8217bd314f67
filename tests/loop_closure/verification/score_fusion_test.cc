// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/loop_closure/verification/score_fusion.h"

#include <cmath>

#include "gtest/gtest.h"

namespace cartographer_ext {
namespace loop_closure {
namespace {

TEST(ScoreFusionTest, EquationSixAsPrinted) {
  ScoreFusionOptions options;
  // S_g one sigma off, S_t on its mean: exp(-1/2) / (exp(-1/2) + 1).
  const double lambda =
      FusionLambda(options, 0.7, {0.6, 0.1}, 0.8, {0.8, 0.05});
  EXPECT_NEAR(lambda, std::exp(-0.5) / (std::exp(-0.5) + 1.), 1e-12);
}

TEST(ScoreFusionTest, FiniteFarFromBothMeansAndWithZeroSigma) {
  ScoreFusionOptions options;
  // The printed formula is 0/0 here.
  const double far = FusionLambda(options, 1., {0., 0.}, 1., {0.2, 0.});
  EXPECT_GE(far, 0.);
  EXPECT_LE(far, 1.);
  EXPECT_LT(far, 1e-10);  // S_g is farther off
  EXPECT_DOUBLE_EQ(FusionLambda(options, 1., {0., 0.}, 1., {0., 0.}), 0.5);
}

TEST(ScoreFusionTest, BlendOfEquationSevenWithTheHistory) {
  ScoreFusionOptions options;
  options.window = 2;
  options.initial_lambda = 0.25;
  ScoreFusion fusion(options);
  EXPECT_NEAR(fusion.Fuse(0.4, 0.8).score, 0.25 * 0.4 + 0.75 * 0.8, 1e-15);
  fusion.AddScores(0.5, 0.7);
  EXPECT_EQ(fusion.Fuse(0.4, 0.8).lambda, 0.25);
  fusion.AddScores(0.7, 0.9);
  // Means 0.6 and 0.8, both sigmas 0.1; S_g two sigmas off, S_t on its mean.
  const FusedScore fused = fusion.Fuse(0.8, 0.8);
  EXPECT_NEAR(fused.lambda, std::exp(-2.) / (std::exp(-2.) + 1.), 1e-9);
  EXPECT_NEAR(fused.score, 0.8, 1e-12);
}

}  // namespace
}  // namespace loop_closure
}  // namespace cartographer_ext
