// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
#include "cartographer_ext/front_end/odometry/odometry_noise_scale.h"

#include <cmath>
#include <limits>

#include "cartographer_ext/common/random.h"
#include "gtest/gtest.h"

namespace cartographer_ext {
namespace front_end {
namespace {

OdometryNoiseScaleOptions AlmostUnbounded() {
  OdometryNoiseScaleOptions options;
  options.least = 0.02;
  return options;
}

// Innovations of odometry whose variance is `truth` times the one assumed.
double Estimate(const double truth, const double match_variance,
                const int count) {
  constexpr double kAssumed = 1e-4;
  OdometryNoiseScale scale(AlmostUnbounded());
  Random random(7);
  for (int i = 0; i != count; ++i) {
    const double innovation =
        std::sqrt(truth * kAssumed + match_variance) * random.Normal();
    scale.Add({innovation * innovation, match_variance, kAssumed});
  }
  return scale.scale();
}

TEST(OdometryNoiseScaleTest, StartsWithWhatTheOptionsSay) {
  EXPECT_EQ(OdometryNoiseScale((OdometryNoiseScaleOptions())).scale(), 1.);
  EXPECT_NEAR(Estimate(1., 2e-5, 1000), 1., 0.15);
}

// The prior yields: with 50 samples half of it is left, with a thousand a tenth.
TEST(OdometryNoiseScaleTest, FindsTheScale) {
  EXPECT_NEAR(Estimate(0.2, 2e-5, 50), 0.6, 0.1);
  EXPECT_NEAR(Estimate(0.2, 2e-5, 2000), 0.27, 0.08);
  EXPECT_NEAR(Estimate(0.5, 2e-5, 2000), 0.55, 0.12);
  // Also where the matches err as much as the assumed odometry.
  EXPECT_NEAR(Estimate(0.2, 1e-4, 2000), 0.27, 0.15);
}

TEST(OdometryNoiseScaleTest, StaysInItsBounds) {
  EXPECT_EQ(Estimate(9., 2e-5, 2000), 1.);
  OdometryNoiseScaleOptions options;
  options.least = 0.3;
  OdometryNoiseScale scale(options);
  for (int i = 0; i != 2000; ++i) scale.Add({0., 1e-4, 1e-4});
  EXPECT_EQ(scale.scale(), 0.3);
  OdometryNoiseScale usual((OdometryNoiseScaleOptions()));
  for (int i = 0; i != 2000; ++i) usual.Add({0., 1e-4, 1e-4});
  EXPECT_EQ(usual.scale(), 0.5);
}

TEST(OdometryNoiseScaleTest, IgnoresWhatIsNoInnovation) {
  OdometryNoiseScale scale((OdometryNoiseScaleOptions()));
  const double infinity = std::numeric_limits<double>::infinity();
  scale.Add({infinity, 1., 1.});
  scale.Add({1., infinity, 1.});
  scale.Add({1., 1., 0.});
  scale.Add({1., 1., infinity});
  EXPECT_EQ(scale.scale(), 1.);
}

// What happened long ago counts less: wheels that begin to slip are found out.
TEST(OdometryNoiseScaleTest, Forgets) {
  OdometryNoiseScale scale(AlmostUnbounded());
  for (int i = 0; i != 3000; ++i) scale.Add({2e-5, 2e-5, 1e-4});
  EXPECT_LT(scale.scale(), 0.15);
  for (int i = 0; i != 1000; ++i) scale.Add({1.2e-4, 2e-5, 1e-4});
  EXPECT_GT(scale.scale(), 0.8);
}

}  // namespace
}  // namespace front_end
}  // namespace cartographer_ext
